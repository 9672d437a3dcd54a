#include "levelray/vdb/vdb_file.hpp"
