// reporter.h  the report for tests/run: every case as it begins, and the first line of its verdict
//
// Every event is a line in the file that TEST_REPORT names, flushed before anything can crash.
// Tabs separate columns:
//     begin           FILE:LINE  NAME  VERDICT  the case runs; again when its first check fails
//     passed, failed  FILE:LINE  NAME  VERDICT  the case has ended
//     sum             CHECKS  ALPHA             statistical checks, probability of a false alarm
#pragma once
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <sstream>
#include <string>

#include "oracle/oracle.h"

// This header, like doctest's reporter that it extends, is only for main.cpp.
namespace {

// The first line with text; control characters would end columns and lines.
std::string one_line(std::string text) {
    text = text.substr(0, text.find('\n', text.find_first_not_of('\n')));
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text;
}

struct Reporter : doctest::ConsoleReporter {
    static inline unsigned ran = 0, failed = 0;  // test cases of the last run

    explicit Reporter(const doctest::ContextOptions& options) : ConsoleReporter(options) {
        if (const char* name = std::getenv("TEST_REPORT")) report = std::fopen(name, "w");
    }
    Reporter(const Reporter&) = delete;
    Reporter& operator=(const Reporter&) = delete;
    ~Reporter() override {
        if (report) std::fclose(report);
    }

    void test_case_start(const doctest::TestCaseData& test) override {
        ConsoleReporter::test_case_start(test);
        running = &test;
        where = place(test);
        verdict.clear();
        write("begin");
    }
    void test_case_end(const doctest::CurrentTestCaseStats& stats) override {
        ConsoleReporter::test_case_end(stats);
        if (!stats.testCaseSuccess && verdict.empty()) verdict = "as its log says";
        write(stats.testCaseSuccess ? "passed" : "failed");
        flush();
    }
    void test_case_exception(const doctest::TestCaseException& e) override {
        ConsoleReporter::test_case_exception(e);
        const std::string what = e.error_string.c_str();
        if (running) tell(place(*running), (e.is_crash ? "crashed: " : "threw: ") + what);
        flush();
    }
    void log_assert(const doctest::AssertData& check) override {
        ConsoleReporter::log_assert(check);
        if (check.m_failed && !(check.m_at & doctest::assertType::is_warn))
            tell(place(check.m_file, check.m_line), verdict_of(check));
    }
    void log_message(const doctest::MessageData& message) override {
        ConsoleReporter::log_message(message);
        if (!(message.m_severity & doctest::assertType::is_warn))
            tell(place(message.m_file, message.m_line), message.m_string.c_str());
    }
    void test_run_end(const doctest::TestRunStats& stats) override {
        ConsoleReporter::test_run_end(stats);
        ran = stats.numTestCasesPassingFilters;
        failed = stats.numTestCasesFailed;
        if (report)
            std::fprintf(report, "sum\t%d\t%g\n", oracle::statistical_checks.load(), oracle::alpha_spent.load());
        flush();
    }

private:
    std::FILE* report = nullptr;
    const doctest::TestCaseData* running = nullptr;
    std::string where, verdict;  // of its first failed check, preferably in its own file
    std::mutex telling;

    static std::string place(const std::string& file, int line) {
        return file + ":" + std::to_string(line);
    }
    static std::string place(const doctest::TestCaseData& test) {
        return place(test.m_file.c_str(), int(test.m_line));
    }

    void write(const char* what) {
        if (!report) return;
        std::fprintf(report, "%s\t%s\t%s\t%s\n", what, where.c_str(),
                     one_line(running->m_name).c_str(), one_line(verdict).c_str());
        std::fflush(report);
    }
    void tell(const std::string& at, const std::string& why) {
        const std::lock_guard lock(telling);
        if (!verdict.empty() || !running) return;
        if (at.starts_with(running->m_file.c_str())) where = at;
        verdict = why;
        write("begin");
    }
    // A signal that ends the program loses unwritten output.
    static void flush() {
        std::cout.flush();
        std::fflush(stdout);
    }

    // The oracle's verdict; otherwise the expression, its values and the notes around it.
    static std::string verdict_of(const doctest::AssertData& check) {
        const std::string expression = check.m_expr;
        const int notes = get_num_active_contexts();
        if (notes > 0 && expression.ends_with(".pass")) return note(notes - 1);
        std::string text = place(check.m_file, check.m_line) + ": " + expression;
        if (check.m_threw)
            text += " threw " + std::string(check.m_exception.c_str());
        else if (check.m_at & doctest::assertType::is_throws)
            text += " did not throw";
        else if (const std::string values = check.m_decomp.c_str();
                 values != expression && values.find("{?}") == values.npos)
            text += "; it is " + values;
        text = one_line(text);
        for (int i = 0; i < notes; ++i) text += "; " + note(i);
        return text;
    }
    static std::string note(int i) {
        std::ostringstream text;
        get_active_contexts()[i]->stringify(&text);
        return one_line(text.str());
    }
};

}  // namespace
