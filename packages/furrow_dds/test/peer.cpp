// dds_test_peer DOMAIN: writes "alive" a hundred times a second until its standard input ends.
#include <poll.h>
#include <unistd.h>

#include <cstdlib>

#include "test_support.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    return 2;
  }
  // A killed process would leave its shared memory.
  furrow::dds::DdsParameters parameters = furrow::dds::test_parameters("peer", {"udp"});
  parameters.domain_id = std::strtol(argv[1], nullptr, 10);
  furrow::dds::DdsTransport transport(parameters);
  const auto writer =
      transport.make_writer("alive", furrow::dds::string_type(), furrow::dds::watched_qos());
  constexpr int kPeriod_ms = 10;
  pollfd input = {STDIN_FILENO, POLLIN, 0};
  while (poll(&input, 1, kPeriod_ms) == 0) writer->write(furrow::dds::make_string("alive"));
  return 0;
}
