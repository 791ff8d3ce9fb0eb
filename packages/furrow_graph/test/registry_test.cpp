#include "furrow_graph/registry.hpp"

#include "fixtures.hpp"
#include "furrow_core/test_support/config_error.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"

namespace furrow::graph {
namespace {

TEST(Registry, NamesAreUnique) {
  Registry registry = test::standard_registry();
  EXPECT_THROW(registry.add<test::Source>("source"), ConfigError);
  EXPECT_EQ(registry.classes().size(), 2u);
}

TEST(Registry, AFileThatIsNoLibraryIsAnError) {
  const TemporaryFolder temporary;
  const auto& folder = temporary.path();
  const auto path = write_text(folder / "libfurrow_component_x.so", "not a library");
  Registry registry;
  registry.add_search_folder(folder);
  EXPECT_NE(error_of(folder,
                     [&] {
                       registry.find("x", {"g.yaml", 2});
                     })
                .find("cannot load"),
            std::string::npos);
  EXPECT_EQ(error_of(folder, [&] { registry.load_library("libm.so.6"); }),
            "libm.so.6: is not a component library: no furrow_register");
}

}  // namespace
}  // namespace furrow::graph
