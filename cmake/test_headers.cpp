// Nothing but its precompiled headers: test_headers.hpp.
