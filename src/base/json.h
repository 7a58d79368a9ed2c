// base/json.h  1  numbers and words for people, and for JSON
#pragma once
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

// "0.982 %"
inline std::string percent(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g %%", 100 * x);
    return text;
}

inline std::string fixed(double x, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, x);
    return text;
}

// With so many digits, wherever the point is: "0.02", and as many as there are before it: "234".
inline std::string significant(double x, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, x);
    return std::string_view(text).find("e+") == std::string_view::npos ? text : fixed(x, 0);
}

namespace json {

inline std::string string(std::string_view text) {
    std::string out = "\"";
    for (char c : text) {
        char escaped[8];
        std::snprintf(escaped, sizeof escaped, "\\u%04x", unsigned(static_cast<unsigned char>(c)));
        if (c == '"' || c == '\\')
            out += '\\', out += c;
        else if (static_cast<unsigned char>(c) < ' ')
            out += escaped;
        else
            out += c;
    }
    return out + '"';
}

// JSON has no NaN: what is not known is null.
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

// An object of one member a line.
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
