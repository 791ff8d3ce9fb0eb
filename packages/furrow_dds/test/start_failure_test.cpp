// A process that cannot start all threads of its transport. This program replaces pthread_create(),
// so that it can refuse a thread as the system would.

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <system_error>

#include "test_support.hpp"

namespace {
std::atomic<int> threads_created = 0;
std::atomic<int> refused_thread = 0;  // by its number since threads_created was 0; 0: none
}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*start)(void*), void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (++threads_created == refused_thread) return EAGAIN;
  return create(thread, attributes, start, argument);
}

namespace furrow::dds {
namespace {

/// Threads that one transport starts, its two senders last.
int threads_of_a_transport(const DdsParameters& parameters) {
  threads_created = 0;
  const DdsTransport transport(parameters);
  return threads_created;
}

TEST(DdsTransport, LeavesNoParticipantBehindIfItsSenderCannotStart) {
  const DdsParameters parameters = test_parameters("short of threads");
  (void)threads_of_a_transport(parameters);  // Fast DDS also starts threads once in a process
  const int last = threads_of_a_transport(parameters);
  for (const int refused : {last - 1, last}) {
    threads_created = 0;
    refused_thread = refused;
    EXPECT_THROW(DdsTransport transport(parameters), std::system_error) << refused;
    refused_thread = 0;
    auto* factory = eprosima::fastdds::dds::DomainParticipantFactory::get_instance();
    EXPECT_TRUE(factory
                    ->lookup_participants(
                        static_cast<eprosima::fastdds::dds::DomainId_t>(parameters.domain_id))
                    .empty())
        << refused;
  }
}

}  // namespace
}  // namespace furrow::dds
