#include "relative_map/io/text.hpp"

#include <algorithm>
#include <boost/locale/encoding_utf.hpp>
#include <cctype>
#include <cmath>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

constexpr const char* kBlanks = " \t\r\n\v\f";

bool begins_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

std::string from_utf_16(const std::string& bytes, bool little_endian) {
  if (bytes.size() % 2 != 0) throw std::runtime_error("is UTF-16 that is cut off within a character");
  std::u16string units;
  units.reserve(bytes.size() / 2);
  for (std::size_t i = 2; i < bytes.size(); i += 2) {  // after the byte order mark
    const auto low = static_cast<unsigned char>(bytes[little_endian ? i : i + 1]);
    const auto high = static_cast<unsigned char>(bytes[little_endian ? i + 1 : i]);
    units.push_back(static_cast<char16_t>(high << 8 | low));
  }
  try {
    return boost::locale::conv::utf_to_utf<char>(units, boost::locale::conv::stop);
  } catch (const boost::locale::conv::conversion_error&) {
    throw std::runtime_error("begins like UTF-16, and is none");
  }
}

std::string as_utf_8(std::string bytes) {
  if (begins_with(bytes, "\xEF\xBB\xBF")) return bytes.substr(3);
  if (begins_with(bytes, "\xFF\xFE")) return from_utf_16(bytes, true);
  if (begins_with(bytes, "\xFE\xFF")) return from_utf_16(bytes, false);
  return bytes;
}

std::string with_plain_line_ends(const std::string& text) {
  if (text.find('\r') == std::string::npos) return text;
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\r') {
      plain += text[i];
    } else if (i + 1 == text.size() || text[i + 1] != '\n') {
      plain += '\n';
    }
  }
  return plain;
}

}  // namespace

std::optional<double> parse_number(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double number = 0.0;
  char rest = 0;
  if (stream >> number && !(stream >> rest) && std::isfinite(number)) return number;
  return std::nullopt;
}

std::string not_a_number(const std::string& text) {
  std::string sentence = "'" + text + "' is not a number";
  const std::string number = trimmed(text);
  const auto holds = [&number](const std::string& any) {
    return number.find_first_of(any) != std::string::npos;
  };
  if (!holds("0123456789")) return sentence;
  if (holds(",") && holds(".")) return sentence + ": thousands must not be set apart";
  if (holds(",")) return sentence + ": the decimal sign must be a point";
  if (holds("NSEWnsw'\"") || number.find("\xC2\xB0") != std::string::npos) {
    return sentence + ": degrees must be decimal, negative in the south and west, without letters or signs";
  }
  if (holds(" :")) return sentence + ": there must be one number; degrees must be decimal, without minutes";
  return sentence;
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string read_text(const std::string& path) {
  const std::string bytes = read_whole_file(path);
  try {
    const std::string text = with_plain_line_ends(as_utf_8(bytes));
    if (text.find('\0') == std::string::npos) return text;
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(path + ": " + fault.what());
  }
  throw std::runtime_error(path + ": holds bytes of zero, and is no text: save it as UTF-8");
}

}  // namespace relative_map::core
