#include "surfaces/text_lines.h"

#include <algorithm>

#include "surfaces/byte_order_mark.h"

namespace spherical_springs::mesh {

TextLines::TextLines(std::istream& in) : in_(in) { skipByteOrderMark(in); }

bool TextLines::readOne(std::string& line) {
  using Traits = std::istream::traits_type;
  std::streambuf& buffer = *in_.rdbuf();
  line.clear();
  Traits::int_type c = buffer.sbumpc();
  if (c == Traits::eof()) return false;
  for (; c != Traits::eof() && c != '\n' && c != '\r'; c = buffer.sbumpc()) {
    line += Traits::to_char_type(c);
  }
  if (c == '\r' && buffer.sgetc() == '\n') buffer.sbumpc();
  ++read_;
  return true;
}

bool TextLines::next(std::string& line) {
  if (!readOne(line)) return false;
  number_ = read_;
  std::string following;
  // A comment may end with the name of a directory.
  while (line.find('#') == std::string::npos && !line.empty() && line.back() == '\\') {
    line.back() = ' ';
    if (readOne(following)) line += following;
  }
  line.resize(std::min(line.size(), line.find('#')));
  return true;
}

}  // namespace spherical_springs::mesh
