// Pieces of HTML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace swiftlet::pages {

using Row = std::vector<std::string>;

// For element content and attributes.
std::string escaped(std::string text);

std::string element(const std::string& name, const std::string& text);  // escapes the text
std::string table(const Row& head, const std::vector<Row>& rows);       // escapes the cells

// A whole document. body: HTML. scripts: run in their order after the body is read.
std::string document(const std::string& title, const std::string& body,
                     const std::vector<std::string_view>& scripts);

// Data for scripts under an id. Scripts read it as text.
std::string data_element(const std::string& id, const std::string& text);

}  // namespace swiftlet::pages
