// Preloaded into the program: makes the n-th of its calls that change files fail, or the last one
// it makes. INCISE_FAULT_AT is n, from 1; INCISE_FAULT is the number of the error to report, or
// "kill", or "half": half of what is to be written is, and then the disk is full. Files that are
// opened to be written count only if INCISE_FAULT_OPEN is there, and then nothing else does. The
// number of calls goes to the file INCISE_FAULT_COUNT when the program ends by itself. From the
// INCISE_FAULT_THREADS-th thread on, none can be made. From the INCISE_FAULT_MEMORY-th request for
// a page of memory or more on, none is granted.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> num_calls = 0;

template <class Function>
Function* original(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// Counts this call. Returns whether it is the one that is to fail.
bool is_the_one(bool opens = false) {
    if (opens != (std::getenv("INCISE_FAULT_OPEN") != nullptr)) return false;
    const char* at = std::getenv("INCISE_FAULT_AT");
    return ++num_calls == (at ? std::atol(at) : 0);
}

/// Makes the call fail that is_the_one(), with errno set; or ends the process.
void fail() {
    const char* fault = std::getenv("INCISE_FAULT");
    if (std::strcmp(fault, "kill") == 0) ::raise(SIGKILL);
    errno = std::strcmp(fault, "half") == 0 ? ENOSPC : std::atoi(fault);
}

/// Whether this call is to fail, with errno set. Does not return if it is to be the last one.
bool fails(bool opens = false) {
    if (!is_the_one(opens)) return false;
    fail();
    return true;
}

struct Counter {
    ~Counter() {
        const char* path = std::getenv("INCISE_FAULT_COUNT");
        if (!path) return;
        if (std::FILE* file = std::fopen(path, "w")) {
            std::fprintf(file, "%ld", num_calls.load());
            std::fclose(file);
        }
    }
} counter;

/// Whether there is no memory of that size, with errno set.
bool is_out_of_memory(std::size_t size) {
    static std::atomic<long> num_requests = 0;
    constexpr std::size_t page = 4096;
    if (size < page) return false;
    const char* at = std::getenv("INCISE_FAULT_MEMORY");
    if (!at || ++num_requests < std::atol(at)) return false;
    errno = ENOMEM;
    return true;
}

bool is_to_be_written(int flags) { return (flags & O_ACCMODE) != O_RDONLY; }

}  // namespace

extern "C" {

// The C library's own: the search for the original would itself ask for memory.
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t number, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) { return is_out_of_memory(size) ? nullptr : __libc_malloc(size); }
void* calloc(size_t number, size_t size) {
    return is_out_of_memory(number * size) ? nullptr : __libc_calloc(number, size);
}
void* realloc(void* memory, size_t size) {
    return is_out_of_memory(size) ? nullptr : __libc_realloc(memory, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
    return is_out_of_memory(size) ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, size_t alignment, size_t size) {
    if (is_out_of_memory(size)) return ENOMEM;
    *memory = __libc_memalign(alignment, size);
    return *memory ? 0 : ENOMEM;
}

int open(const char* path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = (flags & O_CREAT) ? va_arg(arguments, mode_t) : 0;
    va_end(arguments);
    if (is_to_be_written(flags) && fails(true)) return -1;
    return original<int(const char*, int, ...)>("open")(path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = (flags & O_CREAT) ? va_arg(arguments, mode_t) : 0;
    va_end(arguments);
    if (is_to_be_written(flags) && fails(true)) return -1;
    return original<int(int, const char*, int, ...)>("openat")(folder, path, flags, mode);
}
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) {
    static std::atomic<long> num_threads = 0;
    const char* at = std::getenv("INCISE_FAULT_THREADS");
    if (at && ++num_threads >= std::atol(at)) return EAGAIN;
    using Create = int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    return original<Create>("pthread_create")(thread, attributes, start, argument);
}
ssize_t write(int file, const void* bytes, size_t size) {
    const auto next = original<ssize_t(int, const void*, size_t)>("write");
    if (file <= STDERR_FILENO) return next(file, bytes, size);
    // A kill may cut a long write short, but not one of a few pages.
    constexpr size_t few_pages = 16384;
    const char* fault = std::getenv("INCISE_FAULT");
    const bool halves = fault && (std::strcmp(fault, "half") == 0 ||
                                  (std::strcmp(fault, "kill") == 0 && size > few_pages));
    if (!is_the_one()) return next(file, bytes, size);
    if (halves) (void)!next(file, bytes, size / 2);
    fail();
    return -1;
}
int fsync(int file) { return fails() ? -1 : original<int(int)>("fsync")(file); }
int rename(const char* from, const char* to) {
    return fails() ? -1 : original<int(const char*, const char*)>("rename")(from, to);
}
int unlink(const char* path) {
    // Of use to kill in, but hidden files may stay: that is no failure to report.
    const char* fault = std::getenv("INCISE_FAULT");
    if (fault && std::strcmp(fault, "kill") == 0) fails();
    return original<int(const char*)>("unlink")(path);
}
int ftruncate(int file, off_t size) {
    return fails() ? -1 : original<int(int, off_t)>("ftruncate")(file, size);
}

}  // extern "C"
