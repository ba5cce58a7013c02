#include "csv_record.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "relative_map/io/text.hpp"

namespace relative_map::core {

namespace {

const std::string kSeparators = ";\t|,";  // a file with ';' may have decimal commas, which are then refused

}  // namespace

void CsvReader::fail(const std::string& what) const {
  throw std::runtime_error("line " + std::to_string(line_) + ": " + what);
}

bool CsvReader::skip() {
  while (at_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string line = text_.substr(at_, end - at_);
    const std::string content = trimmed(line);
    if (!content.empty() && content[0] != '#') return true;
    if (!content.empty()) comments_.push_back({line_, {content.substr(1)}});
    at_ = std::min(end + 1, text_.size());
    ++line_;
  }
  return false;
}

char CsvReader::next_separator() {
  if (!skip()) return separator_;
  std::string plain;  // what is not quoted
  bool quoted = false;
  for (std::size_t i = at_; i < text_.size() && (quoted || text_[i] != '\n'); ++i) {
    if (text_[i] == '"') quoted = !quoted;
    if (!quoted) plain += text_[i];
  }
  for (char separator : kSeparators) {
    // Tabs between blanks are blanks.
    if (trimmed(plain).find(separator) == std::string::npos) continue;
    if (separator == '\t' && trimmed(plain).find(kBlank) != std::string::npos) return kBlank;
    return separator;
  }
  return kBlank;
}

/// Begins at the quote; ends behind the closing one.
std::string CsvReader::quoted_cell() {
  const std::size_t first_line = line_;
  std::string cell;
  for (++at_; at_ < text_.size(); ++at_) {
    if (text_[at_] == '"') {
      if (at_ + 1 == text_.size() || text_[at_ + 1] != '"') break;
      ++at_;
    }
    if (text_[at_] == '\n') ++line_;
    cell += text_[at_];
  }
  if (at_ == text_.size()) {
    line_ = first_line;
    fail("a quote is not closed");
  }
  ++at_;
  if (at_ < text_.size() && text_[at_] != separator_ && text_[at_] != '\n') {
    fail("'" + std::string(1, text_[at_]) + "' stands behind a closing quote");
  }
  return cell;
}

std::string CsvReader::plain_cell() {
  std::string cell;
  for (; at_ < text_.size() && text_[at_] != separator_ && text_[at_] != '\n'; ++at_) {
    if (text_[at_] == '"') fail("a quote stands within a cell that does not begin with one");
    cell += text_[at_];
  }
  return cell;
}

bool CsvReader::next(CsvRecord& record) {
  if (!skip()) return false;
  record.line = line_;
  record.cells.clear();
  if (separator_ == kBlank) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    record.cells = split(text_.substr(at_, end - at_), kBlank);
    at_ = end;
  } else {
    for (;; ++at_) {
      record.cells.push_back(at_ < text_.size() && text_[at_] == '"' ? quoted_cell() : plain_cell());
      if (at_ == text_.size() || text_[at_] == '\n') break;
    }
  }
  at_ = std::min(at_ + 1, text_.size());
  ++line_;
  return true;
}

std::vector<CsvRecord> CsvReader::take_comments() {
  return std::exchange(comments_, {});
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  std::string cell;
  if (separator == kBlank) {
    while (stream >> cell) cells.push_back(cell);
    return cells;
  }
  while (std::getline(stream, cell, separator)) cells.push_back(cell);
  if (!line.empty() && line.back() == separator) cells.emplace_back();
  return cells;
}

}  // namespace relative_map::core
