// zig's glibc headers have this variable, by which Boost may count references without atomic instructions; a glibc before 2.32
// has not. Ours, which no other library sees, says that there may be several threads.
extern "C" char __libc_single_threaded;
extern "C" char __libc_single_threaded = 0;
