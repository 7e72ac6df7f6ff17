#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// Text as HTML shows it literally, also within quoted attributes.
std::string html_text(std::string_view text);

/// Replaces each {{name}} of a page by its value, in one pass, so that a value may hold anything.
std::string fill_page(std::string_view page,
                      const std::vector<std::pair<std::string_view, std::string_view>>& values);

/// Takes a page part by part.
using TextSink = std::function<void(std::string_view)>;
/// Says a value that is too long to be held at once.
using LongText = std::function<void(const TextSink&)>;

/// The same for pages that are never held at once.
void fill_page(std::string_view page, const std::vector<std::pair<std::string_view, LongText>>& values,
               const TextSink& out);

}  // namespace unravel::tool
