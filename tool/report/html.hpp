#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace unravel {

/// Text as HTML shows it literally, also within quoted attributes.
std::string html_text(std::string_view text);

/// Replaces each {{name}} of a page by its value, in one pass, so that a value may hold anything.
std::string fill_page(std::string_view page,
                      const std::vector<std::pair<std::string_view, std::string_view>>& values);

}  // namespace unravel
