// What the pages of identifications share.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::ground {

// From the beginning of the page to its headline.
std::string page_head(const std::string& title);

// A unit as it is written by hand; nothing for the unit 1.
std::string html_unit(const std::string& unit);

// A table with a row for each.
std::string estimates_html(const std::vector<identification::Estimate>& estimates);

}  // namespace swiftlet::ground
