// Lines of text files of any system.
#pragma once

#include <istream>
#include <string>

namespace spherical_springs::mesh {

/// Reads a text line by line. Lines end with LF, CR LF or CR. A comment begins with # and ends with
/// its line. A backslash at the end of a line without a comment joins the next one to it.
class TextLines {
 public:
  /// Goes past a byte order mark of UTF-8 at the beginning.
  explicit TextLines(std::istream& in);

  /// Reads the next line, without its end and its comment. Returns false at the end of the text.
  bool next(std::string& line);

  /// Returns the number, from 1, of the first of the lines that were joined into the last one read.
  std::size_t number() const { return number_; }

 private:
  bool readOne(std::string& line);

  std::istream& in_;
  std::size_t number_ = 0, read_ = 0;
};

}  // namespace spherical_springs::mesh
