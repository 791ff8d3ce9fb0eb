#pragma once

/// Attributes for clang's thread-safety analysis (-Wthread-safety); other compilers ignore them.
/// https://clang.llvm.org/docs/ThreadSafetyAnalysis.html

#if defined(__clang__)
#define FURROW_THREAD_ATTRIBUTE(x) __attribute__((x))
#else
#define FURROW_THREAD_ATTRIBUTE(x)
#endif

#define FURROW_CAPABILITY(name) FURROW_THREAD_ATTRIBUTE(capability(name))
#define FURROW_SCOPED_CAPABILITY FURROW_THREAD_ATTRIBUTE(scoped_lockable)
/// The member may be used only while the mutex is held.
#define FURROW_GUARDED_BY(mutex) FURROW_THREAD_ATTRIBUTE(guarded_by(mutex))
/// The caller must hold the mutex.
#define FURROW_REQUIRES(...) FURROW_THREAD_ATTRIBUTE(requires_capability(__VA_ARGS__))
#define FURROW_ACQUIRE(...) FURROW_THREAD_ATTRIBUTE(acquire_capability(__VA_ARGS__))
#define FURROW_RELEASE(...) FURROW_THREAD_ATTRIBUTE(release_capability(__VA_ARGS__))
