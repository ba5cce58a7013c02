#pragma once

#include <string>
#include <vector>

namespace relative_map::core {

constexpr char kBlank = ' ';  ///< as a separator: any number of blanks and tabs

/// A record of a CSV file: its cells, without the quotes around them.
struct CsvRecord {
  std::size_t line = 0;  ///< where it begins, from 1
  std::vector<std::string> cells;
};

/// Reads records by the letter of RFC 4180 (section 2), with any separator in the comma's place: a cell may
/// be quoted, and then hold separators, line ends and, doubled, quotes; a quote stands nowhere else. Blanks
/// are part of a cell. Besides, lines of nothing are skipped, and those that begin with '#' are comments.
class CsvReader {
 public:
  /// `text` has plain line ends (see read_text()), and outlives this.
  explicit CsvReader(const std::string& text) : text_(text) {}

  /// The separator of the record that comes next: the first of ; tab | , that stands in it outside of quotes,
  /// else a blank.
  char next_separator();
  void set_separator(char separator) { separator_ = separator; }

  /// False at the end. Throws std::runtime_error, "line N: " with the fault.
  bool next(CsvRecord& record);
  /// What stood before the last record or the end, without '#', by line; takes it away.
  std::vector<CsvRecord> take_comments();

 private:
  /// Skips blank lines and comments; false at the end.
  bool skip();
  std::string quoted_cell();
  std::string plain_cell();
  [[noreturn]] void fail(const std::string& what) const;

  const std::string& text_;
  std::size_t at_ = 0, line_ = 1;
  char separator_ = ',';
  std::vector<CsvRecord> comments_;
};

/// The cells of a line without quotes.
std::vector<std::string> split(const std::string& line, char separator);

}  // namespace relative_map::core
