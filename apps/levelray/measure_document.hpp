// What a suite of measurements hands over: one document, from which come the text on standard output, the
// JSON and the HTML page.
//
// {title, command, version, machine, options, failures: [text], findings: [text], notes: [text], sections:
// [{id, title, text, tables: [table], plots: [plot]}]} Failures break a promise of levelray's; findings are
// what methods that promise nothing lose, or sampling. Texts are plain, in paragraphs.
#pragma once

#include "options.hpp"

#include <string>
#include <vector>

namespace levelray {

// A column of a table: its values are texts or numbers (null: none), the latter shown with that many
// significant digits. `fault`: numbers other than 0, and the word "red", are faults, and shown as such.
// Neighbours of one `group` have it as a heading above theirs. `quoted`: somebody else's figure, shown behind
// ours. `prose`: sentences, which the page breaks into lines, and the text leaves out.
struct Column {
  std::string key, title;
  int digits = 3;
  bool fault = false;
  std::string group = {};
  bool quoted = false;
  bool prose = false;
};

// {id, title, columns: [{key, title, digits, fault; group, quoted, prose where there are}], rows: [[value]]}
class Table {
 public:
  Table(const std::string& id, const std::string& title, std::vector<Column> columns);
  void add(Json::array_t row); // one value per column
  const Json& json() const { return json_; }

 private:
  Json json_;
};

// A log-log plot: {id, title, x, y, series: [{name, slope, points: [[x, y]]}]}. Points that are not positive
// are left out; `slope` may be NaN: null.
class LogLogPlot {
 public:
  LogLogPlot(const std::string& id, const std::string& title, const std::string& x, const std::string& y);
  void add(const std::string& name, double slope, const std::vector<double>& x, const std::vector<double>& y);
  const Json& json() const { return json_; }

 private:
  Json json_;
};

// Error against cost, both logarithmic, a mark for each configuration: {id, title, kind: "trade", x, y,
// series:
// [{name, points: [[x, y, label, in front]]}]}. A name's points make a series. What is not positive is left
// out. In front (the Pareto front) are points that no other equals or betters in both and betters in one.
class TradePlot {
 public:
  TradePlot(const std::string& id, const std::string& title, const std::string& x, const std::string& y);
  void add(const std::string& name, double x, double y, const std::string& label);
  Json json() const;

 private:
  Json json_;
};

// JSON has no NaN: null.
Json finite_json(double value);

// The document as text: failures and findings, then every table.
std::string document_text(const Json& document);

// The document as one HTML page that needs nothing else.
std::string document_page(const Json& document);

} // namespace levelray
