# A room is a folder and a library of one name: sim/forces is sim_forces. It sees the headers of the rooms that it says
# it needs, and of what those need, and of no others: each room has a folder of include paths of its own, in which
# nothing but the room itself is found.

# room_headers(TARGET FOLDER KIND): lets TARGET and who links it include FOLDER's headers as "FOLDER/name.hpp".
function(room_headers target folder kind)
  set(paths ${CMAKE_BINARY_DIR}/rooms/${target})
  get_filename_component(above ${paths}/${folder} DIRECTORY)
  file(MAKE_DIRECTORY ${above})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${paths}/${folder} SYMBOLIC)
  target_include_directories(${target} ${kind} ${paths})
endfunction()

# compile_in_batches(TARGET ...): ten sources at a time.
function(compile_in_batches)
  if(UNRAVEL_UNITY)
    set_target_properties(${ARGN} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10)
  endif()
endfunction()

# room([NEEDS library ...] [APART source ...] [PCH target] [OPTIONS option ...]): the room of the folder that calls it, of
# all sources in it. APART: sources that are not compiled here.
function(room)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "PCH" "NEEDS;APART;OPTIONS")
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  string(REPLACE "/" "_" target ${folder})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  foreach(source IN LISTS arg_APART)
    list(REMOVE_ITEM sources ${CMAKE_CURRENT_SOURCE_DIR}/${source})
  endforeach()
  if(NOT sources)
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${arg_NEEDS})
    room_headers(${target} ${folder} INTERFACE)
    return()
  endif()
  add_library(${target} STATIC ${sources})
  target_link_libraries(${target} PUBLIC ${arg_NEEDS})
  target_compile_options(${target} PRIVATE ${arg_OPTIONS})
  room_headers(${target} ${folder} PUBLIC)
  if(arg_PCH)
    target_precompile_headers(${target} REUSE_FROM ${arg_PCH})
  endif()
  compile_in_batches(${target})
endfunction()
