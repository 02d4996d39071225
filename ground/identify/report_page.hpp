// Common parts of the HTML reports of identifications.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::ground {

// The start of the page, up to and including its headline.
std::string page_head(const std::string& title);

// A unit as HTML, with superscripts; empty for the unit 1.
std::string html_unit(const std::string& unit);

// A table with a row for each estimate.
std::string estimates_html(const std::vector<identification::ParameterEstimate>& estimates);

}  // namespace swiftlet::ground
