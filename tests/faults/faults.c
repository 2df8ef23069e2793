// SPDX-License-Identifier: GPL-3.0-or-later
// A library that goes wrong on purpose: the real one, save that pw_build() comes to harm in the stage asked for.
//
// Linked with the real library, which provides all other functions. PARTWHEEL_FAULT is "FAULT:STAGE", the number of a
// pw_stage; PARTWHEEL_FAULT_METHOD, if set, spares builds until they try this fill method. The fault happens inside the real
// pw_build(): a watching thread sends the building one a signal, whose handler does the harm.
#define _GNU_SOURCE
#include "partwheel.h"

#include <dlfcn.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/uio.h>
#include <unistd.h>

static char fault[32];
static int fault_stage, fault_method;
static const pw_context *watched;
static pthread_t builder;
static volatile int running, happened;
static char *own;  // the building thread's first piece of memory: what it asks for later mostly lies behind it

// Writes over what the library holds in memory, eight bytes in every 64 KB, to the end of what there is. It goes on
// then.
static void corrupt(void) {
    long noise = 0x3ff8a5a5a5a5a5a5;
    for (char *page = own + 4096; page < own + (16 << 20); page += 1 << 16) {
        struct iovec from = {&noise, sizeof noise}, to = {page + ((size_t)page >> 16) % 61 * 64, sizeof noise};
        if (process_vm_writev(getpid(), &from, 1, &to, 1, 0) < 0) break;  // unlike memset() it tells
    }
}

static void harm(int number) {
    (void)number;
    happened = 1;
    pthread_setname_np(pthread_self(), "harmed");  // so that tests can see that it has come to that
    if (!strcmp(fault, "segv")) *(volatile int *)8 = 1;
    if (!strcmp(fault, "abort")) abort();
    if (!strcmp(fault, "exit")) _exit(3);  // not exit(), which may wait for ever within a signal's handler
    if (!strcmp(fault, "exit0")) _exit(0);
    if (!strcmp(fault, "free")) {
        char *volatile never_allocated = fault + 16;
        free(never_allocated);
    }
    if (!strcmp(fault, "corrupt")) corrupt();
    if (!strcmp(fault, "stack")) {
        volatile char *frame = __builtin_alloca(1 << 20);
        frame[0] = 1;
        harm(number + frame[0]);
    }
    if (!strcmp(fault, "kill")) raise(SIGKILL);
    if (!strcmp(fault, "stop")) raise(SIGSTOP);
    while (!strcmp(fault, "loop")) __asm__ volatile("");
    while (!strcmp(fault, "sleep")) pause();
    if (!strcmp(fault, "fill"))
        for (size_t size = 1 << 24; size >= 1 << 12; size >>= 2)
            for (;;) {
                void *page = mmap(0, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
                if (page == MAP_FAILED) break;
                memset(page, 1, size);
            }
}

static int on_the_method(void) {
    pw_fill_method fill_method;
    return !fault_method || (pw_context_fill_method(watched, &fill_method) == PW_OK && (int)fill_method == fault_method);
}

// Keeps the building thread, and all that it starts, on the core it runs on. The watching thread then comes to its turn
// however busy the others are; on another core it has been so late that the stage was over.
static void stay_on_one_core(void) {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    sched_setaffinity(0, sizeof one, &one);
}

static void *watch(void *unused) {
    for (pw_stage stage; running && !happened; usleep(20))
        if (on_the_method() && pw_context_progress(watched, NULL, &stage) == PW_OK && (int)stage >= fault_stage) {
            pthread_kill(builder, SIGUSR2);
            break;
        }
    return unused;
}

pw_status pw_build(pw_context *context, const pw_mesh_view *mesh, const pw_build_options *options,
                   pw_hierarchy **hierarchy) {
    __typeof__(&pw_build) real = (__typeof__(&pw_build))dlsym(RTLD_NEXT, "pw_build");
    const char *wanted = getenv("PARTWHEEL_FAULT"), *fill_method = getenv("PARTWHEEL_FAULT_METHOD");
    pthread_t watcher;
    int watching = 0;
    fault_method = fill_method ? atoi(fill_method) : 0;
    if (wanted && sscanf(wanted, "%31[^:]:%d", fault, &fault_stage) == 2) {
        watched = context;
        builder = pthread_self();
        own = malloc(64);
        running = 1;
        signal(SIGUSR2, harm);
        stay_on_one_core();
        watching = !pthread_create(&watcher, NULL, watch, NULL);
    }
    if (!strcmp(fault, "chatter"))
        for (int i = 0; i < 100000; ++i) printf("This is written to standard output.\n");
    pw_status status = real(context, mesh, options, hierarchy);
    running = 0;
    if (watching) {
        pthread_join(watcher, NULL);
        if (!happened && on_the_method()) harm(0);  // a stage too short to be met
    }
    return status;
}

// The damaged answer of a process whose memory was written over.
pw_status pw_hierarchy_save(pw_context *context, const pw_hierarchy *hierarchy, uint8_t *bytes, size_t capacity,
                            size_t *count) {
    __typeof__(&pw_hierarchy_save) real = (__typeof__(&pw_hierarchy_save))dlsym(RTLD_NEXT, "pw_hierarchy_save");
    pw_status status = real(context, hierarchy, bytes, capacity, count);
    if (status == PW_OK && bytes && !strcmp(fault, "scribble")) memset(bytes + *count / 2, 0x5a, 64);
    return status;
}
