// course/answers.h  the student's side of the pipe: functions that answer a judge's questions
//
// A question is a line "NAME ROWS WIDTH" and ROWS x WIDTH doubles; the answer a line "WIDTH" and as
// many rows of WIDTH doubles, or a line that begins with '!' and says why there is none.  Before
// the first question goes a line: which numbers `real` has.  The judge never loads this code.
#pragma once
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <functional>
#include <string>
#include <utility>

#include "base/vec.h"
#include "course/rows.h"

namespace penumbra::course {

inline vec3 vec3_of(In x, size_t at = 0) { return {real(x[at]), real(x[at + 1]), real(x[at + 2])}; }

struct Question {
    std::string name;
    size_t width;  // numbers it takes; 0: any
    std::function<Out(In)> answer;

    template <class F>
    Question(std::string name_, size_t width_, F f)
        : name(std::move(name_)), width(width_), answer([f](In x) { return row(f(x)); }) {}
};

// All rows of one answer, or why there is none.
inline std::string answer(const Question& q, size_t width, const Out& in, Out& out,
                          size_t& out_width) {
    if (q.width != 0 && q.width != width)
        return "!" + q.name + " takes " + std::to_string(q.width) + " numbers";
    const size_t rows = width == 0 ? 1 : in.size() / width;
    for (size_t i = 0; i < rows; ++i) {
        const Out row = q.answer(In(in).subspan(i * width, width));
        if (i > 0 && row.size() != out_width) return "!" + q.name + " has answers of two lengths";
        out_width = row.size();
        out.insert(out.end(), row.begin(), row.end());
    }
    return std::to_string(out_width);
}

// Answers until no more is asked.  What student's code prints to stdout appears on stderr.
inline int answer_all(const std::vector<Question>& questions) {
    std::FILE* to = ::fdopen(::dup(1), "w");
    if (!to || ::dup2(2, 1) < 0) return 1;
    std::fprintf(to, "%s\n", sizeof(real) == sizeof(double) ? "double" : "float");
    std::fflush(to);
    char name[64];
    size_t rows = 0, width = 0;
    while (std::scanf("%63s %zu %zu", name, &rows, &width) == 3 && std::getchar() == '\n') {
        Out in(rows * width), out;
        if (std::fread(in.data(), sizeof(double), in.size(), stdin) != in.size()) return 1;
        size_t out_width = 0;
        std::string line = "!nobody answers " + std::string(name);
        for (const Question& q : questions)
            if (q.name == name) try {
                    line = answer(q, width, in, out, out_width);
                } catch (const std::exception& e) {
                    line = std::string("!throws: ") + e.what();
                }
        for (char& c : line)
            if (c == '\n') c = ' ';
        std::fprintf(to, "%s\n", line.c_str());
        if (line[0] != '!') std::fwrite(out.data(), sizeof(double), out.size(), to);
        if (std::fflush(to) != 0) return 1;
    }
    return 0;
}

}  // namespace penumbra::course
