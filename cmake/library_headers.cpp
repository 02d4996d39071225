// Empty source file of the target that precompiles library_headers.hpp.
