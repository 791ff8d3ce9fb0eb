include("${CMAKE_CURRENT_LIST_DIR}/FurrowPackage.cmake")
