// The mark that some programs begin texts in UTF-8 with.
#pragma once

#include <istream>
#include <string>

namespace spherical_springs::mesh {

/// Goes past a byte order mark at the beginning of a text, if there is one.
inline void skipByteOrderMark(std::istream& in) {
  const std::string mark = "\xEF\xBB\xBF";
  std::string beginning(mark.size(), '\0');
  in.read(&beginning[0], static_cast<std::streamsize>(beginning.size()));
  if (beginning == mark) return;
  in.clear();
  in.seekg(0);
}

}  // namespace spherical_springs::mesh
