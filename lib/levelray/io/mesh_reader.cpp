#include "levelray/io/mesh_reader.hpp"
