#include "measure_document.hpp"

#include "measure_page_generated.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>

namespace levelray {

Table::Table(const std::string& id, const std::string& title, std::vector<Column> columns) {
  json_ = {{"id", id}, {"title", title}, {"columns", Json::array()}, {"rows", Json::array()}};
  for (const Column& c : columns) {
    Json column = {{"key", c.key}, {"title", c.title}, {"digits", c.digits}, {"fault", c.fault}};
    if (!c.group.empty()) column["group"] = c.group;
    if (c.quoted) column["quoted"] = true;
    if (c.prose) column["prose"] = true;
    json_["columns"].push_back(std::move(column));
  }
}

void Table::add(Json::array_t row) {
  assert(row.size() == json_["columns"].size());
  json_["rows"].push_back(std::move(row));
}

LogLogPlot::LogLogPlot(const std::string& id, const std::string& title, const std::string& x,
                       const std::string& y) {
  json_ = {{"id", id}, {"title", title}, {"x", x}, {"y", y}, {"series", Json::array()}};
}

void LogLogPlot::add(const std::string& name, double slope, const std::vector<double>& x,
                     const std::vector<double>& y) {
  Json points = Json::array();
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i] > 0 && y[i] > 0 && std::isfinite(y[i])) points.push_back({x[i], y[i]});
  json_["series"].push_back({{"name", name}, {"slope", finite_json(slope)}, {"points", std::move(points)}});
}

TradePlot::TradePlot(const std::string& id, const std::string& title, const std::string& x,
                     const std::string& y) {
  json_ = {{"id", id}, {"title", title}, {"kind", "trade"}, {"x", x}, {"y", y}, {"series", Json::array()}};
}

void TradePlot::add(const std::string& name, double x, double y, const std::string& label) {
  Json& all = json_["series"];
  auto series = std::find_if(all.begin(), all.end(), [&](const Json& s) { return s["name"] == name; });
  if (series == all.end()) {
    all.push_back({{"name", name}, {"slope", nullptr}, {"points", Json::array()}});
    series = all.end() - 1;
  }
  if (x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y))
    (*series)["points"].push_back(Json::array({x, y, label, false}));
}

Json TradePlot::json() const {
  Json result = json_;
  const auto beaten = [&](double x, double y) {
    for (const Json& series : json_["series"])
      for (const Json& point : series["points"]) {
        const double u = point[0], v = point[1];
        if (u <= x && v <= y && (u < x || v < y)) return true;
      }
    return false;
  };
  for (Json& series : result["series"])
    for (Json& point : series["points"]) point[3] = !beaten(point[0], point[1]);
  return result;
}

Json finite_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

namespace {

std::string cell_text(const Json& value, int digits) {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_integer()) return fmt::format("{}", value.get<std::int64_t>());
  return fmt::format("{:.{}g}", value.get<double>(), digits);
}

// The groups' names above their first columns, the last of which are widened where names need it; empty
// without groups.
std::string group_line(const Json& columns, std::vector<std::size_t>& widths) {
  for (std::size_t i = 0, end = 0; i < columns.size(); i = end) {
    const std::string group = columns[i].value("group", "");
    std::size_t room = 0;
    for (end = i; end < columns.size() && columns[end].value("group", "") == group; ++end)
      room += widths[end] + (end > i ? 2 : 0);
    if (group.size() > room) widths[end - 1] += group.size() - room;
  }
  std::string line, last;
  std::size_t at = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string group = columns[i].value("group", "");
    if (group != last) {
      line.resize(at, ' ');
      line += group;
      last = group;
    }
    at += widths[i] + 2;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line.empty() ? line : line + "\n";
}

std::string table_text(const Json& table) {
  const Json& columns = table["columns"];
  std::vector<std::vector<std::string>> lines{{}};
  for (const Json& column : columns) lines[0].push_back(column["title"]);
  for (const Json& row : table["rows"]) {
    lines.emplace_back();
    for (std::size_t i = 0; i < columns.size(); ++i)
      lines.back().push_back(cell_text(row[i], columns[i]["digits"]));
  }
  std::string text = table["title"].get<std::string>() + "\n";
  std::vector<std::size_t> widths(columns.size());
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  text += group_line(columns, widths);
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (columns[i].contains("prose")) continue;
      const bool left = !table["rows"].empty() && table["rows"][0][i].is_string();
      row += left ? fmt::format("{}{:<{}}", i ? "  " : "", line[i], widths[i])
                  : fmt::format("{}{:>{}}", i ? "  " : "", line[i], widths[i]);
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

} // namespace

std::string document_text(const Json& document) {
  std::string text = document["title"].get<std::string>() + "\n";
  const auto list = [&](const char* key, const std::string& title) {
    if (document[key].empty()) return;
    text += "\n" + title + "\n";
    for (const Json& line : document[key]) text += "  " + line.get<std::string>() + "\n";
  };
  list("failures", "Failures");
  list("findings", "Findings");
  for (const Json& section : document["sections"])
    for (const Json& table : section["tables"]) text += "\n" + table_text(table);
  return text;
}

std::string document_page(const Json& document) {
  // Inside a script element "</" would end it, and "<!--" begin a comment.
  std::string data = document.dump(-1, ' ', true, Json::error_handler_t::replace), safe;
  safe.reserve(data.size());
  for (const char c : data) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  std::string title;
  for (const char c : document["title"].get<std::string>())
    title += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);

  std::string page = measure_page;
  const auto put = [&](const std::string& mark, const std::string& text) {
    const std::size_t at = page.find(mark);
    assert(at != std::string::npos);
    page.replace(at, mark.size(), text);
  };
  put("{{title}}", title);
  put("{{data}}", safe);
  return page;
}

} // namespace levelray
