#include "core/base/fields.h"

#include <cmath>
#include <sstream>

namespace migiwa {

std::string Range::text() const {
  std::ostringstream out;
  if (!std::isfinite(min) && !std::isfinite(max)) return "of any size";
  if (min == max) {
    out << min;
  } else if (!std::isfinite(max)) {
    out << (openMin ? "more than " : "at least ") << min;
  } else if (!std::isfinite(min)) {
    out << (openMax ? "less than " : "at most ") << max;
  } else {
    out << "in " << (openMin ? "(" : "[") << min << ", " << max << (openMax ? ")" : "]");
  }
  return out.str();
}

}  // namespace migiwa
