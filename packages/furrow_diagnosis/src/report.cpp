#include "furrow_diagnosis/report.hpp"

#include <nlohmann/json.hpp>

#include "furrow_core/text.hpp"
#include "furrow_core/version.hpp"

namespace furrow::diagnosis {
namespace {

using Json = nlohmann::ordered_json;

std::string scaled(const std::optional<double>& value, double factor, int decimals) {
  return value ? fixed(*value * factor, decimals) : "-";
}

Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

}  // namespace

std::string report_text(const Observations& seen, const Diagnosis& diagnosis) {
  std::vector<std::vector<std::string>> rows = {
      {"input", "messages", "Hz", "jitter ms", "delay ms", "writers"}};
  for (const TopicObservation& topic : seen.topics) {
    const StreamFigures figures = figures_of(topic);
    rows.push_back({topic.topic, std::to_string(topic.messages), scaled(figures.rate_hz, 1.0, 1),
                    scaled(figures.jitter_s, 1e3, 1), scaled(figures.delay_s, 1e3, 1),
                    std::to_string(topic.writers.size())});
  }
  std::string text = text_table(rows);
  int order = 0;
  for (const Finding& finding : diagnosis.findings) {
    text += std::to_string(++order) + ". " + finding.topic + ": " + finding.problem + " [" +
            finding.check + "]; " + finding.remedy + "\n";
  }
  for (const std::string& note : diagnosis.not_checked) text += "not checked: " + note + "\n";
  if (diagnosis.findings.empty()) {
    text += "sound: " + std::to_string(seen.topics.size()) + " inputs\n";
  }
  return text;
}

std::string report_json(const std::string& graph, const Observations& seen,
                        const Diagnosis& diagnosis) {
  Json json = {{"version", version()},      {"graph", graph},
               {"seconds", seen.seconds},   {"inputs", Json::array()},
               {"findings", Json::array()}, {"not_checked", diagnosis.not_checked}};
  for (const TopicObservation& topic : seen.topics) {
    const StreamFigures figures = figures_of(topic);
    json["inputs"].push_back({{"topic", topic.topic},
                              {"type", topic.type},
                              {"required", topic.required},
                              {"messages", topic.messages},
                              {"rate_hz", number(figures.rate_hz)},
                              {"jitter_s", number(figures.jitter_s)},
                              {"delay_s", number(figures.delay_s)},
                              {"frame_id", topic.frame},
                              {"writers", topic.writers.size()}});
  }
  for (const Finding& finding : diagnosis.findings) {
    json["findings"].push_back({{"topic", finding.topic},
                                {"check", finding.check},
                                {"rank", to_string(finding.rank)},
                                {"problem", finding.problem},
                                {"remedy", finding.remedy}});
  }
  // Names in messages may be any bytes.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace furrow::diagnosis
