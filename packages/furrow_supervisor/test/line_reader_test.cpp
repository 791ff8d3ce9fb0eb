#include "furrow_supervisor/line_reader.hpp"

#include <gtest/gtest.h>

namespace furrow::supervisor {
namespace {

using Lines = std::vector<std::string>;

TEST(LineReader, JoinsPiecesToLines) {
  LineReader reader;
  EXPECT_EQ(reader.add("fir"), Lines{});
  EXPECT_EQ(reader.add("st\n\nthi"), (Lines{"first", ""}));
  EXPECT_EQ(reader.add("rd\n"), Lines{"third"});
  EXPECT_EQ(reader.take_rest(), std::nullopt);
}

TEST(LineReader, KeepsAnUnfinishedLineForTheEnd) {
  LineReader reader;
  EXPECT_EQ(reader.add("one\ntwo"), Lines{"one"});
  EXPECT_EQ(reader.take_rest(), "two");
  EXPECT_EQ(reader.take_rest(), std::nullopt);
}

TEST(LineReader, CutsALongLineWithoutLosingAByte) {
  constexpr std::size_t kLimit = 4096;
  std::string text;
  for (std::size_t i = 0; i < 3 * kLimit + 10; ++i) text += static_cast<char>('a' + i % 26);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{1000}, text.size()}) {
    LineReader reader(kLimit);
    std::string joined;
    for (std::size_t at = 0; at < text.size(); at += piece) {
      for (const std::string& line : reader.add(std::string_view(text).substr(at, piece))) {
        EXPECT_EQ(line.size(), kLimit);
        joined += line;
      }
    }
    EXPECT_EQ(joined + reader.take_rest().value_or(""), text) << "in pieces of " << piece;
  }
}

TEST(LineReader, LineOfExactlyTheLimitIsOneLine) {
  LineReader reader(4);
  EXPECT_EQ(reader.add("abcd\nef\n"), (Lines{"abcd", "ef"}));
}

}  // namespace
}  // namespace furrow::supervisor
