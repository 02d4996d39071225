// The style and the scripts of the pages: the files in assets/, with the libraries dygraphs and three.js. embed.py
// writes them into the program when it is built.
#pragma once

#include <string_view>

namespace swiftlet::pages {

std::string_view style();           // CSS
std::string_view chart_scripts();   // dygraphs, and charts on it
std::string_view figure_scripts();  // figures of figure.hpp; after the scripts of charts
std::string_view scene_scripts();   // three.js, and paths in space on it; likewise
std::string_view flight_scripts();  // the page of flights; after both
std::string_view live_scripts();    // the live page; after both

}  // namespace swiftlet::pages
