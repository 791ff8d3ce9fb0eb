#include "furrow_dds/log_redirect.hpp"

#include <gtest/gtest.h>

#include <fastdds/dds/log/Log.hpp>
#include <memory>
#include <string>
#include <vector>

namespace furrow::dds {
namespace {

class Memory final : public log::Sink {
 public:
  bool write(const log::Line& line) override {
    texts.push_back(std::string(log::to_string(line.level)) + " " + line.component + ": " +
                    line.message);
    return true;
  }
  std::vector<std::string> texts;
};

void complain(const std::string& message) {
  using eprosima::fastdds::dds::Log;
  Log::QueueLog(message, {"file.cpp", 1, "function", "RTPS_TEST"}, Log::Kind::Error);
  Log::Flush();
}

TEST(LogRedirect, MessagesOfFastDdsBecomeLines) {
  log::Log log;
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  {
    const LogRedirect redirect(log);
    complain("no memory");
  }
  log.flush();
  EXPECT_EQ(sink->texts, (std::vector<std::string>{"error fastdds: RTPS_TEST: no memory"}));
}

TEST(LogRedirect, AfterItsEndMessagesGoToStandardError) {
  log::Log log;
  const auto sink = std::make_shared<Memory>();
  log.add(sink);
  { const LogRedirect redirect(log); }
  testing::internal::CaptureStderr();
  complain("late");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "fastdds: RTPS_TEST: late\n");
  log.flush();
  EXPECT_TRUE(sink->texts.empty());
}

}  // namespace
}  // namespace furrow::dds
