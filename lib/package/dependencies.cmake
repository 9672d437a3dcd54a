# The packages that the libraries are made of. The build includes this file, and so does the installed
# levelrayConfig.cmake, because whoever links static libraries links what they stand on as well.

set(levelray_packages Imath TBB fmt hwy)
set(levelray_io_packages OpenEXR PNG)
set(levelray_vdb_packages OpenVDB)

# OpenVDB brings a find module instead of a configuration file, and beside it modules for packages that have one: take
# those packages' own word.
set(CMAKE_FIND_PACKAGE_PREFER_CONFIG ON)
list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
