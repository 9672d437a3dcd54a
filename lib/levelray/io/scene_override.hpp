// Changes to a scene from outside: --set path.to.key=value.
#pragma once

#include "levelray/io/json_text.hpp"

#include <string>

namespace levelray {

// Sets one value in the scene's tree. `text` is PATH=VALUE: steps are keys, indices from 0 into lists, or the
// "name" of a list's object, with dots between; objects on the way that are missing are made. VALUE is JSON
// or, where it is none, a text. What is set remembers `text` as its origin. Whether keys and values are legal
// is the reader's business. Throws Error(usage) "--set TEXT: reason" for a form or a step that cannot be.
void override_value(JsonValue& scene, const std::string& text);

} // namespace levelray
