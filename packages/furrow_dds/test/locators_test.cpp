#include <gtest/gtest.h>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <map>
#include <set>

#include "test_support.hpp"

namespace furrow::dds {
namespace {

namespace fdds = eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::ReaderDiscoveryInfo;
using Kinds = std::set<std::int32_t>;

/// The locators that the readers of the domain announce, by topic.
class Announced : public fdds::DomainParticipantListener {
 public:
  explicit Announced(int domain) {
    auto qos = fdds::PARTICIPANT_QOS_DEFAULT;
    auto& factory = *fdds::DomainParticipantFactory::get_instance();
    participant_ = factory.create_participant(static_cast<fdds::DomainId_t>(domain), qos, this);
  }
  ~Announced() override {
    participant_->set_listener(nullptr);
    fdds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Announced(const Announced&) = delete;
  Announced& operator=(const Announced&) = delete;

  void on_subscriber_discovery(fdds::DomainParticipant*, ReaderDiscoveryInfo&& found) override {
    const std::lock_guard lock(mutex_);
    auto& [kinds, ports] = of_topic_[found.info.topicName().to_string()];
    for (const auto& locator : found.info.remote_locators().unicast) {
      kinds.insert(locator.kind);
      ports.insert(locator.port);
    }
  }
  [[nodiscard]] Kinds kinds(const std::string& topic) {
    const std::lock_guard lock(mutex_);
    return of_topic_[topic].first;
  }
  [[nodiscard]] std::set<std::uint32_t> ports(const std::string& topic) {
    const std::lock_guard lock(mutex_);
    return of_topic_[topic].second;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::pair<Kinds, std::set<std::uint32_t>>> of_topic_;
  fdds::DomainParticipant* participant_ = nullptr;
};

TEST(Locators, OnlyLargeTypesUseSharedMemory) {
  const DdsParameters parameters = test_parameters("locators");
  Announced announced(static_cast<int>(parameters.domain_id));
  DdsTransport transport(parameters);
  StringInbox inbox;
  const auto ignore = [](const graph::MessagePtr&) {};
  const auto small = transport.make_reader("small", string_type(), {}, inbox.handler());
  const auto large = transport.make_reader("large", msgs::message_type<Image>(), {}, ignore);
  const auto other = transport.make_reader("other", msgs::message_type<Image>(), {}, ignore);

  EXPECT_TRUE(eventually([&] {
    return announced.kinds("rt/small") == Kinds{LOCATOR_KIND_UDPv4} &&
           announced.kinds("rt/large") == Kinds{LOCATOR_KIND_UDPv4, LOCATOR_KIND_SHM} &&
           announced.kinds("rt/other") == Kinds{LOCATOR_KIND_UDPv4, LOCATOR_KIND_SHM};
  }));
  for (const std::uint32_t port : announced.ports("rt/large")) {
    EXPECT_FALSE(announced.ports("rt/other").contains(port)) << port;
  }
}

}  // namespace
}  // namespace furrow::dds
