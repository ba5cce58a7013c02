#pragma once

#include <optional>
#include <string>

namespace relative_map::core {

// What the readers of text files share.

/// The whole of `text` as a finite number with a decimal point, whatever the locale; blanks around it do no
/// harm. None: it is no such number, like "48,1", "48 08.22", "33.8688S", "0x10", "inf" or "".
std::optional<double> parse_number(const std::string& text);

/// Why `text` is no number, as a sentence that begins with it: "'48,1' is not a number: the decimal sign must
/// be a point".
std::string not_a_number(const std::string& text);

/// Without blanks, tabs and line ends around it.
std::string trimmed(const std::string& text);

/// ASCII letters in lower case.
std::string lower(std::string text);

/// A text file as UTF-8 with '\n' at the end of its lines: a byte order mark goes, UTF-16 is converted, and
/// "\r\n" and '\r' end a line, too. Throws std::runtime_error, one sentence with the path, if it can't be
/// read (see whole_file.hpp) or is no text.
std::string read_text(const std::string& path);

}  // namespace relative_map::core
