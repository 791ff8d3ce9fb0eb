#include "rosout.hpp"

#include <utility>

#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/rcl_interfaces.h"

namespace furrow::graph {
namespace {

class RosoutSink final : public log::Sink {
 public:
  RosoutSink(std::unique_ptr<TransportWriter> writer,
             std::function<void(const MessagePtr&)> deliver, bool real_time)
      : writer_(std::move(writer)), deliver_(std::move(deliver)), real_time_(real_time) {}

  bool write(const log::Line& line) override {
    auto message = std::make_shared<rcl_interfaces::msg::Log>();
    message->stamp(to_msg(line.time));
    message->level(static_cast<std::uint8_t>(line.level));
    message->name(line.component);
    message->msg(log::text_of(line));
    // Also without a reader: a later one gets the newest lines.
    if (writer_ != nullptr) writer_->write(message);
    // A text of a library comes at a time of its own: in lock-step, no component may see it.
    if (real_time_ || !line.foreign) deliver_(message);
    return true;
  }

 private:
  std::unique_ptr<TransportWriter> writer_;
  std::function<void(const MessagePtr&)> deliver_;
  bool real_time_;
};

}  // namespace

std::shared_ptr<log::Sink> make_rosout_sink(std::unique_ptr<TransportWriter> writer,
                                            std::function<void(const MessagePtr&)> deliver,
                                            bool real_time) {
  return std::make_shared<RosoutSink>(std::move(writer), std::move(deliver), real_time);
}

}  // namespace furrow::graph
