// Empty source file of the target that precompiles test_headers.hpp.
