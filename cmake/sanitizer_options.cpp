// Linked into every program of a build with sanitizers: what their runtimes are told.
extern "C" {

// Debian's Fast DDS 2.9 frees with sized deletes of a base class: objects of the library, new and gone within it.
const char* __asan_default_options() { return "new_delete_type_mismatch=0"; }

const char* __ubsan_default_options() { return "print_stacktrace=1"; }
}
