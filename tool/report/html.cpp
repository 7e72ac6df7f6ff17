#include "tool/report/html.hpp"

namespace unravel::tool {

std::string html_text(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '<':
                out += "&lt;";
                break;
            case '&':
                out += "&amp;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string fill_page(std::string_view page,
                      const std::vector<std::pair<std::string_view, std::string_view>>& values) {
    std::vector<std::pair<std::string_view, LongText>> texts;
    for (const auto& [key, value] : values)
        texts.emplace_back(key, [text = value](const TextSink& out) { out(text); });
    std::string all;
    fill_page(page, texts, [&](std::string_view part) { all += part; });
    return all;
}

void fill_page(std::string_view page, const std::vector<std::pair<std::string_view, LongText>>& values,
               const TextSink& out) {
    for (;;) {
        const std::size_t open = page.find("{{"), close = page.find("}}", open);
        out(page.substr(0, open));
        if (open == page.npos || close == page.npos) return;
        const std::string_view name = page.substr(open + 2, close - open - 2);
        for (const auto& [key, value] : values) {
            if (key == name) value(out);
        }
        page.remove_prefix(close + 2);
    }
}

}  // namespace unravel::tool
