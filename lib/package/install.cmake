# What `cmake --install` puts where, so that find_package(levelray) and pkg-config work from any prefix.

include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/levelray)

install(DIRECTORY lib/levelray DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")

# One export file per library: a consumer of the numerics alone needs neither OpenEXR nor OpenVDB.
foreach(library levelray levelray_io levelray_vdb)
  install(TARGETS ${library} EXPORT ${library} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT ${library} NAMESPACE levelray:: FILE ${library}-targets.cmake DESTINATION ${package_dir})
endforeach()

set(vdb_reader_path ${CMAKE_INSTALL_LIBEXECDIR}/levelray/levelray-vdb-reader)
set(exr_reader_path ${CMAKE_INSTALL_LIBEXECDIR}/levelray/levelray-exr-reader)
configure_package_config_file(lib/package/config.cmake.in ${PROJECT_BINARY_DIR}/package/levelrayConfig.cmake
                              INSTALL_DESTINATION ${package_dir} PATH_VARS vdb_reader_path exr_reader_path)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/levelrayConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/levelrayConfig.cmake ${PROJECT_BINARY_DIR}/package/levelrayConfigVersion.cmake
              lib/package/dependencies.cmake DESTINATION ${package_dir})

# pkg-config: the libraries are static, so what they stand on is named in full and not as private.
function(levelray_pkg_config name description requires libs)
  file(RELATIVE_PATH prefix_from_pc ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  configure_file(lib/package/pkgconfig.pc.in ${PROJECT_BINARY_DIR}/package/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/package/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
levelray_pkg_config(levelray "${PROJECT_DESCRIPTION}" "Imath tbb fmt libhwy openmesh" "-llevelray")
levelray_pkg_config(levelray_io "Files and pictures for levelray" "levelray OpenEXR libpng" "-llevelray_io")
levelray_pkg_config(levelray_vdb "OpenVDB files for levelray" "levelray_io" "-llevelray_vdb -lopenvdb")

install(TARGETS levelray-vdb-reader levelray-exr-reader DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/levelray)
if(TARGET levelray_program)
  install(TARGETS levelray_program DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES data/scene.schema.json data/scene_keys.md DESTINATION ${CMAKE_INSTALL_DATADIR}/levelray)
  install(FILES apps/levelray/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME levelray)
endif()
