// What a time was measured on.
#pragma once

#include "options.hpp"

namespace levelray {

// {processor, hardware_threads, compiler, flags, load_average}: the load at this moment, null where unknown.
Json machine_json();

} // namespace levelray
