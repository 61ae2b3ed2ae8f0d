// Text of reports: escapes for XML, widths, numbers for readers.
#pragma once

#include <string>
#include <string_view>

namespace sinew::report {

// Text for an element or attribute of XML and HTML: < > & " ' as entities; bytes that are not UTF-8
// and control characters that XML 1.0 does not allow become U+FFFD.
std::string escaped(std::string_view text);

// The number of characters of a text: its UTF-8 code points.
int width(std::string_view text);

// A number with this many significant digits, without trailing zeros: "15.2", "1.5e-07". NaN is
// "-", infinity "inf" or "-inf".
std::string number(double value, int digits = 4);

// A share as a percentage with its sign: percent(-0.165) is "-16.5 %". NaN is "-".
std::string percent(double share, int decimals = 1);

}  // namespace sinew::report
