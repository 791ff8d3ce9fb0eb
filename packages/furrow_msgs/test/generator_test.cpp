#include <gtest/gtest.h>

#include "furrow_core/file.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"
#include "generated_code.hpp"

namespace furrow::msgs {
namespace {

class Generator : public testing::Test {
 protected:
  Result<IdlFile> read(const std::string& text) {
    const auto file = folder_.path() / "some_msgs.idl";
    EXPECT_TRUE(write_file_atomically(file, text).ok());
    return read_idl_file(file);
  }
  std::string error(const std::string& text) {
    const auto file = read(text);
    return file.ok() ? std::string() : file.error().message;
  }
  TemporaryFolder folder_;
};

constexpr const char* kEnumeration =
    "// Not of the enumeration.\n\n// What is done.\nmodule Kind_Constants {\n"
    "  const uint8 SAFE_STATE = 1;  // until reset\n  const uint8 RUN = 7;\n};\n"
    "@final struct Kind { uint8 value; };\n";

std::string in_module(const std::string& text) {
  return "module some_msgs { module msg {\n" + text + "}; };\n";
}

TEST_F(Generator, KeepsTheFilesStructsInTheirOrder) {
  ASSERT_TRUE(write_file_atomically(folder_.path() / "base.idl",
                                    "module base { module msg { @final struct A { long x; }; }; };")
                  .ok());
  const auto file = read("#include \"base.idl\"\n" +
                         in_module("@final struct Z { base::msg::A a; };  // last letter first\n"
                                   "@final struct B { Z z; };\n"));
  ASSERT_FALSE(file.ok());  // a scoped name is needed: "Z" alone is unknown
  const auto scoped = read("#include \"base.idl\"\n" +
                           in_module("@final struct Z { base::msg::A a; };  // last letter first\n"
                                     "@final struct B { some_msgs::msg::Z z; };\n"));
  ASSERT_TRUE(scoped.ok()) << scoped.error().message;
  EXPECT_EQ(scoped->module, "some_msgs");
  EXPECT_EQ(scoped->names, (std::vector<std::string>{"Z", "B"}));
  EXPECT_EQ(scoped->text.find("letter"), std::string::npos);
  EXPECT_LT(scoped->text.find("struct A"), scoped->text.find("struct Z"));
}

TEST_F(Generator, MakesAnEnumClassWithItsComments) {
  auto file = read(in_module(kEnumeration));
  ASSERT_TRUE(file.ok()) << file.error().message;
  const GeneratedCode code = enums_code({std::move(*file)});
  EXPECT_NE(code.header.find("/// What is done.\nenum class Kind : std::uint8_t {\n"
                             "  kSafeState = 1,  ///< until reset\n  kRun = 7,\n};\n"),
            std::string::npos)
      << code.header;
  EXPECT_EQ(code.header.find("Not of the enumeration"), std::string::npos);
  EXPECT_NE(code.source.find("return \"safe_state\";"), std::string::npos);
}

TEST_F(Generator, RefusesTypesThatRos2CannotRead) {
  EXPECT_NE(error(in_module("struct A { long x; };")).find("must be '@final struct'"),
            std::string::npos);
  EXPECT_NE(error("module other { @final struct A { long x; }; };").find("module msg"),
            std::string::npos);
  EXPECT_NE(error(in_module("union A {};")).find("some_msgs.idl: IDL line 2: 'union'"),
            std::string::npos);
  const auto with_value = [&](const std::string& value) {
    std::string text = kEnumeration;
    text.replace(text.find("= 7"), 3, "= " + value);
    return error(in_module(text));
  };
  EXPECT_NE(with_value("1").find("the value stands twice"), std::string::npos);
  EXPECT_NE(with_value("256").find("Kind::RUN: must be"), std::string::npos);
  EXPECT_EQ(with_value("255"), "");
  EXPECT_EQ(read_idl_file(folder_.path() / "none.idl").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace furrow::msgs
