# Functions shared by Furrow's packages. A package's CMakeLists.txt is then a list of what it holds:
#
#   find_package(furrow_cmake REQUIRED)
#   furrow_package()
#   find_package(furrow_core REQUIRED)
#   furrow_library(furrow_geometry SOURCES src/camera.cpp PUBLIC furrow_core::furrow_core)
#   furrow_test(camera_test SOURCES test/camera_test.cpp LINK furrow_geometry)
#   furrow_export(DEPENDENCIES furrow_core)

include(GNUInstallDirs)

set(FURROW_SANITIZE "" CACHE STRING "Sanitizers: address (with undefined), thread, or empty")
option(FURROW_FUZZ "Instrument for libFuzzer and build the fuzz programs; needs clang" OFF)

# Language level, build type, run paths and sanitizers for the whole package.
macro(furrow_package)
  set(CMAKE_CXX_STANDARD 20)
  set(CMAKE_CXX_STANDARD_REQUIRED ON)
  set(CMAKE_CXX_EXTENSIONS OFF)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  set(BUILD_SHARED_LIBS ON)
  # A small source spends most of its compile time on headers (Eigen, OpenCV, GoogleTest, messages).
  # A batch of sources parses them once. So a name in an anonymous namespace is unique in its target,
  # or its file is named in furrow_compile_alone().
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)
  # Binaries start from any folder, also without the setup script.
  set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/../lib")
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
  endif()
  # -O2 everywhere: -O3 costs build time and gains nothing measurable on the planners.
  set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
  if(FURROW_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
      message(FATAL_ERROR "FURROW_FUZZ needs clang: use launch_scripts/build.sh --profile fuzz")
    endif()
    add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
                        -fno-omit-frame-pointer -g1)
    add_link_options(-fsanitize=address,undefined)
  elseif(FURROW_SANITIZE STREQUAL "address")
    add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all
                        -fno-omit-frame-pointer -g1)
    add_link_options(-fsanitize=address,undefined)
  elseif(FURROW_SANITIZE STREQUAL "thread")
    # It does not know fences, and says so.
    add_compile_options(-fsanitize=thread -g1 -Wno-tsan)
    add_link_options(-fsanitize=thread)
  elseif(FURROW_SANITIZE)
    message(FATAL_ERROR "FURROW_SANITIZE is '${FURROW_SANITIZE}'; use address or thread")
  endif()
  include(CTest)
  if(BUILD_TESTING)
    find_package(GTest REQUIRED)
    include(GoogleTest)
  endif()
endmacro()

# A libFuzzer program, with FURROW_FUZZ only. tools/fuzz.sh runs all of them, each from the seeds that
# the package's fuzz/make_seeds.py writes.
function(furrow_fuzzer name)
  if(NOT FURROW_FUZZ)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;DEFINITIONS" ${ARGN})
  add_executable(${name}_fuzzer ${ARG_SOURCES})
  furrow_warnings(${name}_fuzzer)
  target_compile_definitions(${name}_fuzzer PRIVATE ${ARG_DEFINITIONS})
  target_link_options(${name}_fuzzer PRIVATE -fsanitize=fuzzer)
  target_link_libraries(${name}_fuzzer PRIVATE ${ARG_LINK})
endfunction()

# Sources that are not compiled in a batch with others of their target.
function(furrow_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

function(furrow_warnings target)
  # Designated initializers leave members at their defaults on purpose. In a batch of sources the
  # compiler takes every source but the first for a header (subobject-linkage).
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                         -Wno-sign-conversion -Wno-missing-field-initializers -Wnon-virtual-dtor
                         -Woverloaded-virtual)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # clang, which is used for fuzzing, warns of other things.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage -Werror)
  endif()
endfunction()

# A library with its public headers under include/, installed and exported.
function(furrow_library target)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(ARG_SOURCES)
    add_library(${target} ${ARG_SOURCES})
    furrow_warnings(${target})
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(${PROJECT_NAME}::${target} ALIAS ${target})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  target_link_libraries(${target} ${scope} ${ARG_PUBLIC})
  if(ARG_PRIVATE)
    target_link_libraries(${target} PRIVATE ${ARG_PRIVATE})
  endif()
  install(TARGETS ${target} EXPORT ${PROJECT_NAME}Targets
          LIBRARY DESTINATION lib ARCHIVE DESTINATION lib RUNTIME DESTINATION bin)
  if(EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/include")
    install(DIRECTORY include/ DESTINATION include)
  endif()
endfunction()

# A program; installed into bin.
function(furrow_executable target)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${target} ${ARG_SOURCES})
  furrow_warnings(${target})
  target_link_libraries(${target} PRIVATE ${ARG_LINK})
  install(TARGETS ${target} RUNTIME DESTINATION bin)
endfunction()

# A Google Benchmark program, which `furrow bench` runs; left out where find_package(benchmark) found
# nothing.
function(furrow_benchmark target)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  if(NOT benchmark_FOUND)
    message(STATUS "Google Benchmark not found: no ${target}")
    return()
  endif()
  add_executable(${target} ${ARG_SOURCES})
  furrow_warnings(${target})
  target_link_libraries(${target} PRIVATE ${ARG_LINK} benchmark::benchmark)
  install(TARGETS ${target} RUNTIME DESTINATION lib/${PROJECT_NAME})
endfunction()

# A GoogleTest program. FURROW_TEST_DATA_DIR names the package's test folder. AMONG_SYSTEM_TESTS: it
# takes long in real time, and is run with the system tests, beside others.
function(furrow_test target)
  if(NOT BUILD_TESTING)
    return()
  endif()
  cmake_parse_arguments(ARG "AMONG_SYSTEM_TESTS" "TIMEOUT" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_executable(${target} ${ARG_SOURCES})
  furrow_warnings(${target})
  target_link_libraries(${target} PRIVATE ${ARG_LINK} GTest::gtest GTest::gtest_main)
  # A test's own code runs once: a quarter of its compile time is worth more than its speed.
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_compile_definitions(${target} PRIVATE
    FURROW_TEST_DATA_DIR="${CMAKE_CURRENT_SOURCE_DIR}/test")
  if(ARG_AMONG_SYSTEM_TESTS)
    install(TARGETS ${target} RUNTIME DESTINATION lib/${PROJECT_NAME})
    return()
  endif()
  # One ctest entry a program: starting a process for each case would dominate the run.
  add_test(NAME ${target} COMMAND ${target}
           --gtest_output=xml:${CMAKE_BINARY_DIR}/test_results/${PROJECT_NAME}/${target}.gtest.xml)
  set_tests_properties(${target} PROPERTIES TIMEOUT ${ARG_TIMEOUT})
endfunction()

# Installs the package's CMake configuration. DEPENDENCIES: packages that its users must find too.
function(furrow_export)
  cmake_parse_arguments(ARG "" "" "DEPENDENCIES" ${ARGN})
  string(REPLACE ";" " " FURROW_EXPORT_DEPENDENCIES "${ARG_DEPENDENCIES}")
  set(folder share/${PROJECT_NAME}/cmake)
  install(EXPORT ${PROJECT_NAME}Targets NAMESPACE ${PROJECT_NAME}:: DESTINATION ${folder})
  configure_file("${furrow_cmake_DIR}/furrow_packageConfig.cmake.in"
                 "${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}Config.cmake" @ONLY)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}Config.cmake" package.xml
          DESTINATION ${folder})
endfunction()
