# Shaders compiled by glisten as a part of a CMake build.
#
#   include(Glisten)                       # with this folder on CMAKE_MODULE_PATH
#   glisten_add_program(phong
#     SOURCES shaders/phong.vert shaders/phong.frag
#     TARGETS wgsl spirv                   # without it, these two
#     DEFINES LIGHTS=4 SHADOWS
#     INCLUDES shaders/include
#     OUTPUT_DIRECTORY shaders             # below CMAKE_CURRENT_BINARY_DIR; without it, this
#     OPTIONS --deny warnings              # any flags of `glisten compile`
#     REFLECTION phong                     # its name; without it, that of the first file without its stage
#   )
#   glisten_add_program(uber PERMUTATIONS shaders/uber.toml)
#   add_dependencies(app phong uber)
#
# Each call makes a target that is built by `all`. Its property GLISTEN_OUTPUTS lists the files. Files that shaders include are
# found out while building: a change of one of them compiles what reads it, and nothing else.
#
# GLISTEN_EXECUTABLE names the program, GLISTEN_CACHE a folder in which results are kept.

cmake_minimum_required(VERSION 3.20)

find_program(GLISTEN_EXECUTABLE glisten DOC "The shader compiler glisten")
set(GLISTEN_CACHE "" CACHE PATH "A folder in which glisten keeps results (none: no cache but that of the environment)")

# The name of the reflection: that of the first file without what tells its stage, as glisten reads it.
function(_glisten_stem result file)
  set(long vertexshader vertex vert fragmentshader fragment frag pixel geometryshader geometry geom)
  set(words vertexshader vertex vert vs vp fragmentshader fragment frag pixel fs fp ps geometryshader geometry geom gs)
  string(JOIN "|" extensions vs vsh glslv fs fsh glslf gs gsh vp fp ${long})
  set(extension "\\.[^.]*$")
  get_filename_component(name "${file}" NAME)
  string(TOLOWER "${name}" lower)
  string(REGEX REPLACE "${extension}" "" stem "${name}")
  if(lower MATCHES "\\.(${extensions})$" OR NOT lower MATCHES "\\.(glsl|sdr)$")
    set(${result} "${stem}" PARENT_SCOPE)
    return()
  endif()
  if(lower MATCHES "\\.sdr$")
    list(APPEND words v f g)
  endif()
  string(TOLOWER "${stem}" lower)
  if(lower MATCHES "\\.(${extensions})$")
    string(REGEX REPLACE "${extension}" "" stem "${stem}")
    set(words)
  endif()
  string(LENGTH "${stem}" length)
  foreach(word IN LISTS words)
    string(LENGTH "${word}" end)
    math(EXPR start "${length} - ${end}")
    set(rest)
    if(lower STREQUAL word)
      set(rest program)
    elseif(lower MATCHES "[-_.]${word}$")
      math(EXPR start "${start} - 1")
      string(SUBSTRING "${stem}" 0 ${start} rest)
    elseif(lower MATCHES "${word}$")
      string(SUBSTRING "${stem}" 0 ${start} before)
      string(SUBSTRING "${stem}" ${start} 1 first)
      if(before MATCHES "[a-z0-9]$" AND first MATCHES "[A-Z]")
        set(rest "${before}")
      endif()
    endif()
    if("${rest}" STREQUAL "" AND lower MATCHES "^${word}[-_.]")
      math(EXPR end "${end} + 1")
      string(SUBSTRING "${stem}" ${end} -1 rest)
    endif()
    if(NOT "${rest}" STREQUAL "")
      set(stem "${rest}")
      break()
    endif()
  endforeach()
  set(${result} "${stem}" PARENT_SCOPE)
endfunction()

function(glisten_add_program name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "OUTPUT_DIRECTORY;PERMUTATIONS;REFLECTION" "SOURCES;TARGETS;DEFINES;INCLUDES;OPTIONS")
  if(ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "glisten_add_program(${name}): unknown: ${ARG_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT GLISTEN_EXECUTABLE)
    message(FATAL_ERROR "glisten_add_program(${name}): there is no glisten; set GLISTEN_EXECUTABLE")
  endif()
  if((ARG_SOURCES AND ARG_PERMUTATIONS) OR NOT (ARG_SOURCES OR ARG_PERMUTATIONS))
    message(FATAL_ERROR "glisten_add_program(${name}): write either SOURCES or PERMUTATIONS")
  endif()
  if(NOT ARG_OUTPUT_DIRECTORY)
    set(ARG_OUTPUT_DIRECTORY "${name}.shaders")
  endif()
  if(NOT ARG_TARGETS)
    set(ARG_TARGETS wgsl spirv)
  endif()
  get_filename_component(folder "${ARG_OUTPUT_DIRECTORY}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_BINARY_DIR}")
  file(RELATIVE_PATH folder "${CMAKE_CURRENT_BINARY_DIR}" "${folder}")

  # Names are relative to the folder of the build: a depfile means them so, and a cache serves other folders, too.
  set(inputs)
  set(names)
  foreach(source IN LISTS ARG_SOURCES ARG_PERMUTATIONS)
    get_filename_component(path "${source}" ABSOLUTE)
    list(APPEND inputs "${path}")
    file(RELATIVE_PATH path "${CMAKE_CURRENT_BINARY_DIR}" "${path}")
    list(APPEND names "${path}")
  endforeach()

  set(extension_wgsl wgsl)
  set(extension_spirv spv)
  set(extension_msl metal)
  set(extension_hlsl hlsl)
  set(extension_glsl glsl)
  set(flags)
  foreach(target IN LISTS ARG_TARGETS)
    if(NOT DEFINED extension_${target})
      message(FATAL_ERROR "glisten_add_program(${name}): `${target}` is no target: wgsl, spirv, msl, hlsl, glsl")
    endif()
    list(APPEND flags --target "${target}")
  endforeach()
  foreach(define IN LISTS ARG_DEFINES)
    list(APPEND flags -D "${define}")
  endforeach()
  foreach(include IN LISTS ARG_INCLUDES)
    get_filename_component(path "${include}" ABSOLUTE)
    file(RELATIVE_PATH path "${CMAKE_CURRENT_BINARY_DIR}" "${path}")
    list(APPEND flags -I "${path}")
  endforeach()
  if(GLISTEN_CACHE)
    list(APPEND flags --cache "${GLISTEN_CACHE}")
  endif()

  set(outputs)
  if(ARG_PERMUTATIONS)
    list(APPEND flags --permutations ${names} --prune)
    list(APPEND outputs "${folder}/index.json")
    # Only the index is known as an output before the build.
    set_property(DIRECTORY APPEND PROPERTY ADDITIONAL_CLEAN_FILES "${CMAKE_CURRENT_BINARY_DIR}/${folder}")
  else()
    string(REPLACE ";" "," program "${names}")
    list(APPEND flags --program "${program}")
    foreach(source IN LISTS ARG_SOURCES)
      get_filename_component(file "${source}" NAME)
      foreach(target IN LISTS ARG_TARGETS)
        list(APPEND outputs "${folder}/${file}.${extension_${target}}")
      endforeach()
    endforeach()
    list(GET ARG_SOURCES 0 first)
    if(NOT ARG_REFLECTION)
      _glisten_stem(ARG_REFLECTION "${first}")
    endif()
    list(APPEND outputs "${folder}/${ARG_REFLECTION}.json")
  endif()
  list(TRANSFORM outputs PREPEND "${CMAKE_CURRENT_BINARY_DIR}/" OUTPUT_VARIABLE paths)

  add_custom_command(
    OUTPUT ${paths}
    COMMAND "${GLISTEN_EXECUTABLE}" --quiet compile ${flags} ${ARG_OPTIONS} -o "${folder}" --depfile "${name}.glisten.d"
    DEPENDS ${inputs} "${GLISTEN_EXECUTABLE}"
    DEPFILE "${CMAKE_CURRENT_BINARY_DIR}/${name}.glisten.d"
    WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}"
    COMMENT "Compiling the shaders of ${name}"
    VERBATIM)
  add_custom_target(${name} ALL DEPENDS ${paths})
  set_target_properties(${name} PROPERTIES GLISTEN_OUTPUTS "${paths}")
endfunction()
