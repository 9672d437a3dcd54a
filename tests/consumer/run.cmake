# Installs BUILD_DIR into a scratch prefix, moves that prefix, and builds and runs the consumer against it.
# Usage: cmake -D BUILD_DIR=… -D SOURCE_DIR=… -D WORK_DIR=… -D CXX=… -D FLAGS=… -P run.cmake
file(REMOVE_RECURSE ${WORK_DIR})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/first)
file(RENAME ${WORK_DIR}/first ${WORK_DIR}/prefix) # an installation holds no paths of where it was made
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -G Ninja -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK_DIR}/build --output-on-failure --no-tests=error)
run(${WORK_DIR}/prefix/bin/levelray --version)

# The same through pkg-config, where there is one.
find_program(PKG_CONFIG pkg-config)
if(NOT PKG_CONFIG)
  message("skipped: the .pc files, because pkg-config is not installed")
  return()
endif()
file(GLOB pc_dir ${WORK_DIR}/prefix/lib*/pkgconfig ${WORK_DIR}/prefix/lib/*/pkgconfig)
set(ENV{PKG_CONFIG_PATH} ${pc_dir})
set(ENV{LEVELRAY_VDB_READER} ${WORK_DIR}/prefix/libexec/levelray/levelray-vdb-reader)
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs levelray_vdb levelray_io levelray
                OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags} ${FLAGS}")
run(${CXX} -std=c++20 ${SOURCE_DIR}/main.cpp -o ${WORK_DIR}/consumer_by_pkg_config ${flags})
run(${WORK_DIR}/consumer_by_pkg_config ${WORK_DIR})
