// text/json.h  1  numbers and words for people, and for JSON
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace penumbra {

inline std::string fixed(double x, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, x);
    return text;
}

// With so many significant digits: "0.02"; but all digits before the decimal point: "234".
inline std::string significant(double x, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, x);
    return std::string_view(text).find("e+") == std::string_view::npos ? text : fixed(x, 0);
}

namespace json {

// Number of bytes of the text's first character; 0: the text does not begin with UTF-8.
inline size_t utf8_length(std::string_view text) {
    const uint32_t first = static_cast<unsigned char>(text[0]);
    const size_t n = first < 0x80         ? 1
                     : first >> 5 == 0x06 ? 2
                     : first >> 4 == 0x0e ? 3
                     : first >> 3 == 0x1e ? 4
                                          : 0;
    if (n <= 1 || n > text.size()) return n == 1;
    uint32_t point = first & (0x7f >> n);
    for (const char c : text.substr(1, n - 1)) {
        if ((c & 0xc0) != 0x80) return 0;
        point = point << 6 | (c & 0x3f);
    }
    constexpr uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = point >> 11 == 0x1b;
    return point < least[n] || point > 0x10ffff || surrogate ? 0 : n;
}

// A name of a file may hold any bytes: U+FFFD stands for each that is not part of UTF-8.
inline std::string string(std::string_view text) {
    std::string out = "\"";
    for (size_t n; !text.empty(); text.remove_prefix(n > 0 ? n : 1)) {
        n = utf8_length(text);
        const char c = text[0];
        char escaped[8];
        std::snprintf(escaped, sizeof escaped, "\\u%04x", unsigned(static_cast<unsigned char>(c)));
        if (c == '"' || c == '\\')
            out += '\\', out += c;
        else if (static_cast<unsigned char>(c) < ' ')
            out += escaped;
        else
            out += n > 0 ? text.substr(0, n) : "\\ufffd";
    }
    return out + '"';
}

// JSON has no NaN: an unknown number is null.
inline std::string number(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    return std::isfinite(x) ? text : "null";
}

inline std::string numbers(std::array<double, 3> x) {
    std::string text = "[";
    return text += number(x[0]) + ", " + number(x[1]) + ", " + number(x[2]) + ']';
}

inline std::string truth(bool b) { return b ? "true" : "false"; }

// An object with one member per line.
class Object {
public:
    void add(const std::string& key, const std::string& value) {
        text_ += (text_.empty() ? "  \"" : ",\n  \"") + key + "\": " + value;
    }
    std::string text() const { return "{\n" + text_ + "\n}\n"; }

private:
    std::string text_;
};

}  // namespace json

}  // namespace penumbra
