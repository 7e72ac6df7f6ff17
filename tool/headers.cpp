// Nothing but the headers that every room includes (CMakeLists.txt beside this file).
