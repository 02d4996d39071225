// Empty source file of the target that precompiles light_headers.hpp.
