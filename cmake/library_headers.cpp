// Nothing but its precompiled headers: library_headers.hpp.
