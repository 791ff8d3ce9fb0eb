#include "furrow_launch/graph_picture.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

namespace furrow::launch {
namespace {

constexpr int kMargin = 24;
constexpr int kTitle = 56;
constexpr int kTopicWidth = 330;
constexpr int kColumn = 84;
constexpr int kRow = 30;
constexpr int kBand = 26;
constexpr int kLetter = 8;

constexpr const char* kInside = "#6b7280";
constexpr const char* kBetweenProcesses = "#1d6fb8";
constexpr const char* kBetweenHosts = "#c2570c";
constexpr const char* kDashes = "stroke-dasharray=\"5 4\"";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

struct Column {
  std::string component;
  std::string process;
  std::string host;
};

class Picture {
 public:
  explicit Picture(std::span<const graph::PlacedProcess> processes) {
    for (const graph::PlacedProcess& process : processes) {
      for (const std::string& component : process.components) {
        columns_.push_back({component, process.name, process.host});
      }
    }
    // Processes of a host stand side by side, the hosts in the order in which they first come.
    std::vector<std::string> hosts;
    for (const Column& column : columns_) {
      if (std::ranges::find(hosts, column.host) == hosts.end()) hosts.push_back(column.host);
    }
    std::ranges::stable_sort(columns_, {}, [&](const Column& column) {
      return std::ranges::find(hosts, column.host) - hosts.begin();
    });
    for (std::size_t i = 0; i < columns_.size(); ++i) index_[columns_[i].component] = i;
    for (const Column& column : columns_) {
      name_height_ =
          std::max(name_height_, 24 + kLetter * static_cast<int>(column.component.size()));
    }
    has_hosts_ = hosts.size() > 1 || (!hosts.empty() && !hosts.front().empty());
  }

  std::string draw(const std::string& title, std::span<const graph::Connection> connections) {
    const int top = kTitle + (has_hosts_ ? kBand : 0) + kBand + name_height_;
    const int width = x_of(columns_.size()) + kMargin;
    const int rows = static_cast<int>(connections.size());
    const int height = top + rows * kRow + kMargin;
    out_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width << "\" height=\""
         << height << "\" viewBox=\"0 0 " << width << ' ' << height
         << "\" font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"13\">\n"
         << "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    text(kMargin, 30, title, "font-size=\"18\" font-weight=\"bold\"");
    legend();
    int y = kTitle;
    if (has_hosts_) {
      bands(
          y, height - kMargin / 2, [](const Column& c) { return c.host; }, "#eef2f7", "#c3ccd8");
      y += kBand;
    }
    bands(
        y, height - kMargin / 2, [](const Column& c) { return c.host + "\n" + c.process; },
        "#ffffff", "#93a1b5");
    y += kBand;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const int x = middle_of(i);
      out_ << "<text transform=\"translate(" << x + 4 << ' ' << y + name_height_ - 12
           << ") rotate(-90)\" font-weight=\"bold\">" << escaped(columns_[i].component)
           << "</text>\n<line x1=\"" << x << "\" y1=\"" << y + name_height_ - 4 << "\" x2=\"" << x
           << "\" y2=\"" << height - kMargin << "\" stroke=\"#dfe4ea\"/>\n";
    }
    for (std::size_t i = 0; i < connections.size(); ++i) {
      topic(connections[i], top + static_cast<int>(i) * kRow + kRow / 2);
    }
    out_ << "</svg>\n";
    return out_.str();
  }

 private:
  static int x_of(std::size_t column) {
    return kMargin + kTopicWidth + static_cast<int>(column) * kColumn;
  }
  static int middle_of(std::size_t column) { return x_of(column) + kColumn / 2; }

  void text(int x, int y, const std::string& what, const std::string& style) {
    out_ << "<text x=\"" << x << "\" y=\"" << y << "\" " << style << '>' << escaped(what)
         << "</text>\n";
  }

  void legend() {
    int x = kMargin;
    circle(x + 6, 47, kInside);
    text(x + 18, 51, "publishes", "font-size=\"11\" fill=\"#444\"");
    x += 95;
    arrowhead(x + 6, 42, kInside);
    text(x + 18, 51, "reads", "font-size=\"11\" fill=\"#444\"");
    x += 75;
    for (const auto& [colour, what] : {std::pair{kInside, "within a process"},
                                       {kBetweenProcesses, "between processes"},
                                       {kBetweenHosts, "between hosts"}}) {
      if (colour == kBetweenHosts && !has_hosts_) continue;
      line(x, x + 22, 47, colour, "");
      text(x + 28, 51, what, "font-size=\"11\" fill=\"#444\"");
      x += 155;
    }
    line(x, x + 22, 47, kInside, kDashes);
    text(x + 28, 51, "from outside", "font-size=\"11\" fill=\"#444\"");
  }

  void line(int from, int to, int y, const std::string& colour, const char* style) {
    out_ << "<line x1=\"" << from << "\" y1=\"" << y << "\" x2=\"" << to << "\" y2=\"" << y
         << "\" stroke=\"" << colour << "\" stroke-width=\"2\" " << style << "/>\n";
  }
  void circle(int x, int y, const std::string& colour) {
    out_ << "<circle cx=\"" << x << "\" cy=\"" << y << "\" r=\"5\" fill=\"" << colour << "\"/>\n";
  }
  void arrowhead(int x, int y, const std::string& colour) {
    out_ << "<path d=\"M" << x - 6 << ' ' << y << " L" << x + 6 << ' ' << y << " L" << x << ' '
         << y + 10 << " Z\" fill=\"#ffffff\" stroke=\"" << colour << "\" stroke-width=\"2\"/>\n";
  }

  /// A box around each run of columns with the same key; its last line is its name.
  template <class Key>
  void bands(int y, int bottom, Key key, const char* fill, const char* stroke) {
    for (std::size_t first = 0; first < columns_.size();) {
      std::size_t last = first;
      while (last < columns_.size() && key(columns_[last]) == key(columns_[first])) ++last;
      const std::string full = key(columns_[first]);
      const std::string name = full.substr(full.find('\n') + 1);
      const int width = static_cast<int>(last - first) * kColumn - 6;
      out_ << "<rect x=\"" << x_of(first) + 3 << "\" y=\"" << y << "\" width=\"" << width
           << "\" height=\"" << bottom - y << "\" rx=\"6\" fill=\"" << fill << "\" stroke=\""
           << stroke << "\"/>\n";
      // A name that is wider than its box is cut; the columns below name the components in full.
      const auto fits = static_cast<std::size_t>(std::max(1, (width - 8) / kLetter));
      const std::string shown =
          name.size() <= fits ? name : name.substr(0, fits > 1 ? fits - 1 : 1) + "…";
      text(x_of(first) + 3 + width / 2, y + 18, shown,
           "text-anchor=\"middle\" font-size=\"12\" fill=\"#333\"");
      first = last;
    }
  }

  const char* reach_of(const graph::Connection& connection) const {
    const char* reach = kInside;
    for (const std::string& from : connection.publishers) {
      for (const std::string& to : connection.readers) {
        const Column& a = columns_[index_.at(from)];
        const Column& b = columns_[index_.at(to)];
        if (a.host != b.host) return kBetweenHosts;
        if (a.process != b.process) reach = kBetweenProcesses;
      }
    }
    return reach;
  }

  void topic(const graph::Connection& connection, int y) {
    const std::string colour = reach_of(connection);
    text(kMargin, y + 1, connection.topic, "");
    text(kMargin, y + 13, std::string(connection.type->ros_name), "font-size=\"9\" fill=\"#888\"");
    std::vector<int> ends;
    for (const std::string& name : connection.publishers) {
      ends.push_back(middle_of(index_.at(name)));
    }
    for (const std::string& name : connection.readers) ends.push_back(middle_of(index_.at(name)));
    if (ends.empty()) return;
    const auto [left, right] = std::ranges::minmax(ends);
    line(left, right, y, colour, connection.publishers.empty() ? kDashes : "");
    for (const std::string& name : connection.publishers) {
      circle(middle_of(index_.at(name)), y, colour);
    }
    for (const std::string& name : connection.readers) {
      arrowhead(middle_of(index_.at(name)), y, colour);
    }
  }

  std::vector<Column> columns_;
  std::map<std::string, std::size_t> index_;
  bool has_hosts_ = false;
  int name_height_ = 0;  // of the components' names, which stand upright
  std::ostringstream out_;
};

}  // namespace

std::string graph_picture(const graph::GraphSpec& graph,
                          std::span<const graph::Connection> connections,
                          std::span<const graph::PlacedProcess> processes) {
  return Picture(processes).draw(graph.name, connections);
}

}  // namespace furrow::launch
