#include "furrow_experiments/paper_figures.hpp"

namespace furrow::experiments {

const PaperFigures* paper_figures(std::string_view generated_as) {
  for (const PaperFigures& figures : kPaperFigures) {
    if (figures.generated_as == generated_as) return &figures;
  }
  return nullptr;
}

}  // namespace furrow::experiments
