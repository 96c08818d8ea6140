#pragma once

#include <string>

namespace slipway {

// Three significant digits, and all digits before the point: "0.619", "12.3", "1000" and not "1e+03".
std::string plain_number(double value);

// With so many decimals that it can be told from another number: 9.998 beside 10 is "9.998", 3 beside 10 with
// two decimals "3.00".
std::string number_beside(double value, double other, int decimals);

}  // namespace slipway
