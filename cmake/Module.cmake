# Warnings and sanitizers are a target; -Werror is for CI.
add_library(pbnbrdf_warnings INTERFACE)
target_compile_options(pbnbrdf_warnings INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
                       # It takes sources that are compiled as one for headers.
                       $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>
                       $<$<BOOL:${PBNBRDF_WERROR}>:-Werror>)
if(PBNBRDF_SANITIZE)
  add_compile_options(-fsanitize=${PBNBRDF_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${PBNBRDF_SANITIZE})
  # Eigen allocates otherwise under the address sanitizer, and libceres frees what headers allocated.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
if(PBNBRDF_COVERAGE)
  # Threads may lose each other's counts, which matters less than that atomic ones take a hundred times as long.
  add_compile_options(--coverage -fprofile-update=single)
  add_link_options(--coverage)
endif()
if(PBNBRDF_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# pbnbrdf_precompile(TARGET [HEADER ...]): the headers of the standard library that most files include are parsed
# once for all targets, which takes about a second off each file; with others, once more for this target. Files
# still include what they use: ./do sanitize builds without this.
function(pbnbrdf_precompile target)
  if(ARGN OR target STREQUAL pbnbrdf_base)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <functional> <map> <memory> <numbers>
                              <optional> <span> <sstream> <string> <string_view> <utility> <vector> ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM pbnbrdf_base)
  endif()
endfunction()

# pbnbrdf_module(NAME [COMPONENT component] [MODULES module ...] [LIBS target ...] [PRIVATE_LIBS target ...]
#                [HEADERS target ...])
#
# The library pbnbrdf_NAME from src/NAME/*.cc and include/pbnbrdf/NAME/*.h. Each module's headers have an
# include root of their own, so that including one of a module that isn't linked doesn't compile:
#   "pbnbrdf/NAME/x.h"  public: for users, installed;
#   "NAME/x.h"          internal: for the modules of this project that link NAME;
#   "x.h"               for the module itself.
# HEADERS are libraries of headers that only the module's own sources include.
# COMPONENT: core if not given.
function(pbnbrdf_module name)
  cmake_parse_arguments(M "" "COMPONENT" "MODULES;LIBS;PRIVATE_LIBS;HEADERS" ${ARGN})
  if(NOT M_COMPONENT)
    set(M_COMPONENT core)
  endif()
  set(root ${PROJECT_BINARY_DIR}/include_roots/${name})
  file(MAKE_DIRECTORY ${root}/pbnbrdf)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/include/pbnbrdf/${name} ${root}/pbnbrdf/${name} SYMBOLIC)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/src/${name} ${root}/${name} SYMBOLIC)

  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cc)
  if(sources)
    set(scope PUBLIC)
    add_library(pbnbrdf_${name} STATIC ${sources})
    target_link_libraries(pbnbrdf_${name} PRIVATE $<BUILD_INTERFACE:pbnbrdf_warnings>)
    pbnbrdf_precompile(pbnbrdf_${name})
  else()
    set(scope INTERFACE)
    add_library(pbnbrdf_${name} INTERFACE)
  endif()
  target_compile_features(pbnbrdf_${name} ${scope} cxx_std_20)
  target_include_directories(pbnbrdf_${name} ${scope} $<BUILD_INTERFACE:${root}>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM M_MODULES PREPEND pbnbrdf_)
  target_link_libraries(pbnbrdf_${name} ${scope} ${M_MODULES} ${M_LIBS})
  if(M_PRIVATE_LIBS)
    target_link_libraries(pbnbrdf_${name} PRIVATE ${M_PRIVATE_LIBS})
  endif()
  foreach(headers ${M_HEADERS})
    target_link_libraries(pbnbrdf_${name} PRIVATE $<BUILD_INTERFACE:${headers}>)
  endforeach()
  set_target_properties(pbnbrdf_${name} PROPERTIES EXPORT_NAME module_${name})
  install(TARGETS pbnbrdf_${name} EXPORT pbnbrdf-${M_COMPONENT})
endfunction()

# pbnbrdf_component(NAME MODULE ...): what users link as pbnbrdf::NAME.
function(pbnbrdf_component name)
  list(TRANSFORM ARGN PREPEND pbnbrdf_)
  add_library(pbnbrdf_component_${name} INTERFACE)
  target_link_libraries(pbnbrdf_component_${name} INTERFACE ${ARGN})
  set_target_properties(pbnbrdf_component_${name} PROPERTIES EXPORT_NAME ${name})
  add_library(pbnbrdf::${name} ALIAS pbnbrdf_component_${name})
  install(TARGETS pbnbrdf_component_${name} EXPORT pbnbrdf-${name})
  set_property(GLOBAL APPEND PROPERTY PBNBRDF_COMPONENTS ${name})
endfunction()

# pbnbrdf_embed(TARGET FILE NAME): the text of FILE as the constant NAME, for TARGET's own sources, in a
# header called as FILE is, with _text.h for its extension.
function(pbnbrdf_embed target file name)
  cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE source)
  get_filename_component(stem ${file} NAME_WE)
  set(folder ${PROJECT_BINARY_DIR}/embedded/${target})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  file(READ ${source} text)
  file(CONFIGURE OUTPUT ${folder}/${stem}_text.h @ONLY
       CONTENT "// Made from ${file}.\ninline constexpr char @name@[] = R\"EMBEDDED(@text@)EMBEDDED\";\n")
  target_include_directories(${target} PRIVATE $<BUILD_INTERFACE:${folder}>)
endfunction()
