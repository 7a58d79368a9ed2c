// oracle/arrays.cpp  build/oracle: the checks of oracle.h for arrays in files, from any language
//
//   build/oracle points --domain sphere -n 1000000 -o points.npy
//   build/oracle density samples.npy pdf.npy --domain sphere
//
// A file is NumPy's .npy, or text with a row of numbers in each line.  Exit status: 0 passed, 1
// refused, 2 a command or file that cannot be used.
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "oracle/oracle.h"

namespace {

constexpr const char* usage = R"(usage: oracle CHECK FILES [OPTIONS]

  points -o FILE               write points, a row each, at which the pdf is to be evaluated
  density SAMPLES PDF          samples, a row each, have the density whose values there PDF has
  mean VALUES TRUTH            the mean of VALUES is the number TRUTH
  equal VALUES VALUES          two arrays of numbers have the same mean
  counts COUNTS PROBABILITIES  counts follow probabilities that sum to 1
  image IMAGE ERRORS TRUTH     an image with its standard errors has the mean TRUTH:
                               height x width, or height x width x 3

A file is NumPy's .npy, or text: a row of numbers in each line, with commas or blanks between.

  --domain D     of points and density, the same in both: sphere (default; directions, per solid
                 angle), square ([0,1]^2), interval:A,B, box:A,B,A,B,... (lower and upper end of
                 each coordinate), triangle:X,Y,Z,X,Y,Z,X,Y,Z (or two coordinates for each corner)
  -n N           points: how many (default: 1000000); PDF has its values at all of them, in their
                 order.  density: samples drawn, if some failed and
                 are not in the file.  image: samples of a pixel, for the words of a verdict
  --axis X,Y,Z   of a hemisphere or lobe, to name mistakes (default: the mean of the samples)
  --alpha A      probability that what is right is refused (default: 1e-6)
  --tolerance T  relative error that is forgiven (default: 0)
  --name NAME    first word of the verdict, and name of the picture, which a refusal draws into
                 the folder that ORACLE_PICTURES names

Exit status: 0 passed, 1 refused, 2 a command or file that cannot be used.
)";

struct Unusable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// ---- Files --------------------------------------------------------------------------------------

struct Array {
    std::string file;
    std::vector<size_t> shape = {};
    std::vector<double> numbers = {};  // the last index runs fastest
    bool single = false;               // they were floats

    size_t columns() const {
        return shape.size() > 1 && shape[0] > 0 ? numbers.size() / shape[0] : 1;
    }
    std::string sized() const {
        std::string sizes;
        for (size_t n : shape) sizes += (sizes.empty() ? "" : " x ") + std::to_string(n);
        return file + ": " + sizes + " numbers";
    }
    template <size_t N>
    std::vector<oracle::Point<N>> rows() const {
        if (columns() != N || numbers.size() / N != shape[0])
            throw Unusable(sized() + "; a row of this domain has " + std::to_string(N));
        std::vector<oracle::Point<N>> points(shape[0]);
        for (size_t i = 0; i < numbers.size(); ++i) points[i / N][i % N] = numbers[i];
        return points;
    }
};

template <class T>
void read_numbers(const char* bytes, bool swapped, std::vector<double>& numbers) {
    for (double& number : numbers) {
        char own[sizeof(T)];
        std::copy_n(bytes, sizeof(T), own);
        if (swapped) std::reverse(own, own + sizeof(T));
        number = double(std::bit_cast<T>(own));
        bytes += sizeof(T);
    }
}
using Reader = void (*)(const char*, bool, std::vector<double>&);
struct Type {
    size_t bytes;
    Reader read;
};
template <class T>
constexpr Type type_of = {sizeof(T), read_numbers<T>};
const std::map<std::string, Type> types = {
    {"f4", type_of<float>},   {"f8", type_of<double>},   {"i4", type_of<int32_t>},
    {"i8", type_of<int64_t>}, {"u4", type_of<uint32_t>}, {"u8", type_of<uint64_t>},
    {"i2", type_of<int16_t>}, {"u2", type_of<uint16_t>}, {"i1", type_of<int8_t>},
    {"u1", type_of<uint8_t>}, {"b1", type_of<uint8_t>}};
constexpr char foreign = std::endian::native == std::endian::little ? '>' : '<';

// The value of a key in the header of a .npy, a Python dictionary: without quotes or brackets.
std::string value_of(const std::string& key, const std::string& header) {
    size_t from = header.find("'" + key + "':");
    if (from == std::string::npos) return "";
    from = header.find_first_not_of(' ', from + key.size() + 3);
    if (from == std::string::npos) return "";
    const char first = header[from], last = first == '(' ? ')' : first == '\'' ? '\'' : ',';
    from += last != ',';
    return header.substr(from, header.find(last, from) - from);
}

// NumPy's format, versions 1 to 3 (numpy.lib.format): 6 bytes "\x93NUMPY", two of the version, the
// header's length in 2 bytes (from version 2 on 4), header, numbers.
Array read_npy(const std::string& file, const std::string& bytes) {
    const size_t lengths = bytes.size() > 6 && bytes[6] > 1 ? 4 : 2;
    size_t begin = 8 + lengths;
    for (size_t i = 0; i < lengths && 8 + i < bytes.size(); ++i)
        begin += size_t(static_cast<unsigned char>(bytes[8 + i])) << 8 * i;
    if (begin > bytes.size()) throw Unusable(file + ": ends within its header");
    const std::string header = bytes.substr(8 + lengths, begin - 8 - lengths);
    const std::string name = value_of("descr", header);
    if (name.empty()) throw Unusable(file + ": has no header of NumPy's");
    if (value_of("fortran_order", header) != "False")
        throw Unusable(file + ": is in the order of Fortran: save numpy.ascontiguousarray(...)");
    const auto type = types.find(name.substr(1));
    if (type == types.end())
        throw Unusable(file + ": has numbers of type '" + name +
                       "': save float32, float64 or integers");
    Array a{file};
    size_t count = 1;
    std::istringstream shape(value_of("shape", header));
    for (size_t n; shape >> n; shape.ignore()) {
        a.shape.push_back(n);
        count = n > 0 && count > bytes.size() / n ? bytes.size() : count * n;  // beyond the file
    }
    if (a.shape.empty()) a.shape = {1};
    const size_t size = bytes.size() - begin;
    if (size % type->second.bytes != 0 || size / type->second.bytes != count)
        throw Unusable(a.sized() + " of " + std::to_string(type->second.bytes) +
                       " bytes expected, " + std::to_string(size) + " bytes found");
    a.single = type->first == "f4";
    a.numbers.resize(count);
    type->second.read(&bytes[begin], name[0] == foreign, a.numbers);
    return a;
}

// The first line may have names of columns.
Array read_text(const std::string& file, const std::string& bytes) {
    Array a{file, {0, 0}};
    std::istringstream lines(bytes);
    size_t at = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::string here = file + ":" + std::to_string(++at) + ": ";
        for (char& c : line)
            if (std::string(",;\t\r").find(c) != std::string::npos) c = ' ';
        std::istringstream words(line);
        size_t found = 0, names = 0;
        for (std::string word; words >> word; ++found) {
            char* end;
            a.numbers.push_back(std::strtod(word.c_str(), &end));
            names += end != word.c_str() + word.size();
        }
        if (names > 0 && a.shape[0] > 0)
            throw Unusable(here + "'" + line + "' is no row of numbers");
        if (names > 0 && (at > 1 || names < found))
            throw Unusable(here + "'" + line + "' is no row of numbers, nor of names");
        if (names > 0) a.numbers.clear();
        if (names > 0 || found == 0) continue;
        if (a.shape[0]++ == 0) a.shape[1] = found;
        if (found != a.shape[1])
            throw Unusable(here + std::to_string(found) + " numbers; the rows before have " +
                           std::to_string(a.shape[1]));
    }
    if (a.shape[0] == 0) throw Unusable(file + ": has no numbers");
    if (a.shape[1] == 1) a.shape.pop_back();
    return a;
}

Array read(const std::string& file) {
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    std::ostringstream all;
    if (in) all << in.rdbuf();
    const std::string bytes = all.str();
    if (!in || errno != 0) throw Unusable(file + ": cannot be read: " + std::strerror(errno));
    if (bytes.empty()) throw Unusable(file + ": has no numbers");
    return bytes.starts_with("\x93NUMPY") ? read_npy(file, bytes) : read_text(file, bytes);
}

// As .npy in double, or as text with 17 digits.
template <size_t N>
void write(const std::string& file, const std::vector<oracle::Point<N>>& points) {
    std::ofstream out(file, std::ios::binary);
    if (file.ends_with(".npy")) {
        std::string header =
            oracle::say("{'descr': '%cf8', 'fortran_order': False, 'shape': (%zu, %zu), }",
                        foreign == '>' ? '<' : '>', points.size(), N);
        header.resize(128 - 10 - 1, ' ');  // numbers begin at a multiple of 64
        header += '\n';
        out << "\x93NUMPY\1" << '\0' << char(header.size()) << '\0' << header;
        out.write(reinterpret_cast<const char*>(points.data()),
                  std::streamsize(points.size() * sizeof(oracle::Point<N>)));
    } else {
        out.precision(17);
        for (const auto& p : points)
            for (size_t k = 0; k < N; ++k) out << p[k] << (k + 1 < N ? ',' : '\n');
    }
    if (!out.flush()) throw Unusable(file + ": cannot be written: " + std::strerror(errno));
}

// ---- Commands -----------------------------------------------------------------------------------

struct Command {
    std::vector<std::string> words = {};  // the check and its files
    std::string domain = "sphere", output = {};
    oracle::Options options = {};
};

double number(const std::string& word) {
    char* end;
    const double x = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != 0) throw Unusable("'" + word + "' is no number");
    return x;
}
std::vector<double> numbers(const std::string& list) {
    std::vector<double> all;
    std::istringstream in(list);
    for (std::string word; std::getline(in, word, ',');) all.push_back(number(word));
    return all;
}
template <size_t N>
oracle::Point<N> point(const double* first) {
    oracle::Point<N> p;
    std::copy_n(first, N, p.begin());
    return p;
}

Command parsed(int count, char** arguments) {
    Command c;
    for (int i = 1; i < count; ++i) {
        const std::string word = arguments[i];
        if (word.size() < 2 || word[0] != '-' ||
            std::isdigit(static_cast<unsigned char>(word[1])) || word[1] == '.') {
            c.words.push_back(word);
            continue;
        }
        if (++i == count) throw Unusable(word + " needs a value");
        const std::string value = arguments[i];
        oracle::Options& o = c.options;
        if (word == "--domain")
            c.domain = value;
        else if (word == "-o")
            c.output = value;
        else if (word == "--name")
            o.name = value;
        else if (word == "-n" && number(value) >= 1 && number(value) <= 1e9)
            o.n = uint64_t(number(value));
        else if (word == "--alpha" && number(value) > 0 && number(value) < 1)
            o.alpha = number(value);
        else if (word == "--tolerance" && number(value) >= 0 && number(value) < 1)
            o.tolerance = number(value);
        else if (word == "--axis" && numbers(value).size() == 3)
            o.axis = point<3>(numbers(value).data());
        else
            throw Unusable(word + " " + value + ": no such option, or not a value of it");
    }
    return c;
}

// f(domain), for a domain in words.
template <class F>
auto with_domain(const std::string& words, F f) {
    const size_t colon = std::min(words.find(':'), words.size());
    const std::string name = words.substr(0, colon);
    const std::vector<double> x = numbers(words.substr(std::min(colon + 1, words.size())));
    if (name == "sphere" && x.empty()) return f(oracle::Sphere{});
    if (name == "square" && x.empty()) return f(oracle::Square{});
    if (name == "triangle" && x.size() == 9)
        return f(oracle::Triangle(point<3>(&x[0]), point<3>(&x[3]), point<3>(&x[6])));
    if (name == "triangle" && x.size() == 6)
        return f(oracle::Triangle(point<2>(&x[0]), point<2>(&x[2]), point<2>(&x[4])));
    auto box = [&]<size_t D>(std::integral_constant<size_t, D>) {
        oracle::Box<D> b;
        for (size_t k = 0; k < D; ++k) {
            b.lower[k] = x[2 * k], b.upper[k] = x[2 * k + 1];
            if (!(b.lower[k] < b.upper[k] && std::isfinite(b.upper[k] - b.lower[k])))
                throw Unusable("domain " + words + ": an end is not above the other");
        }
        return f(b);
    };
    if ((name == "interval" || name == "box") && x.size() == 2)
        return box(std::integral_constant<size_t, 1>());
    if (name == "box" && x.size() == 4) return box(std::integral_constant<size_t, 2>());
    if (name == "box" && x.size() == 6) return box(std::integral_constant<size_t, 3>());
    if (name == "box" && x.size() == 8) return box(std::integral_constant<size_t, 4>());
    throw Unusable("domain '" + words +
                   "': sphere, square, interval:A,B, box:A,B,A,B,... or triangle:X,Y,Z,... with "
                   "that many numbers");
}

// `density` makes those that `points` wrote, by their number.
template <class Domain>
auto points_of(const Domain& domain, size_t n) {
    oracle::Random random(oracle::seed_of("oracle points"));
    return oracle::points_in(random, domain, n);
}

oracle::Draws draws(const std::string& file) {
    const Array a = read(file);
    oracle::Draws d;
    d.values = a.numbers;
    if (a.single) d.unit = 0x1p-24;
    return d;
}

oracle::Verdict verdict_of(const Command& c) {
    const auto& [words, domain, output, o] = c;
    const std::string check = words[0];
    auto takes = [&](const char* name, size_t files) {
        if (check == name && words.size() != files + 1)
            throw Unusable(check + " takes " + std::to_string(files) + " files or numbers");
        return check == name;
    };
    if (takes("points", 0)) {
        if (output.empty()) throw Unusable("points: name a file to write, -o FILE");
        const size_t n = with_domain(domain, [&](const auto& d) {
            const auto points = points_of(d, o.n ? o.n : 1000000);
            write(output, points);
            return points.size();
        });
        return {true, 1, 0,
                std::to_string(n) + " points of the domain " + domain + " in " + output};
    }
    if (takes("density", 2)) {
        const Array samples = read(words[1]), pdf = read(words[2]);
        if (pdf.columns() != 1) throw Unusable(pdf.sized() + "; expected one for each point");
        return with_domain(domain, [&](const auto& d) {
            const auto points = points_of(d, pdf.numbers.size());
            using Row = std::decay_t<decltype(points[0])>;
            return oracle::expect_samples(samples.rows<std::tuple_size_v<Row>>(), points,
                                          pdf.numbers, d, o);
        });
    }
    if (takes("mean", 2)) return oracle::judge("mean", draws(words[1]), number(words[2]), o, 200);
    if (takes("equal", 2)) {
        const oracle::Draws a = draws(words[1]), b = draws(words[2]);
        for (const auto& [file, d] : {std::pair{words[1], &a}, {words[2], &b}})
            if (const std::string why = d->problem(200); !why.empty())
                return oracle::detail::failure(file + ": " + why, o);
        return oracle::expect_equal(a.estimate(), b.estimate(), o);
    }
    if (takes("counts", 2))
        return oracle::expect_counts(read(words[1]).numbers, read(words[2]).numbers, o);
    if (takes("image", 3)) {
        const Array image = read(words[1]), errors = read(words[2]), truth = read(words[3]);
        if (image.shape.size() < 2 || (image.shape.size() == 3 && image.shape[2] != 3) ||
            image.shape.size() > 3)
            throw Unusable(image.sized() + "; expected height x width, or height x width x 3");
        for (const Array* other : {&errors, &truth})
            if (other->shape != image.shape) throw Unusable(other->sized() + "; " + image.sized());
        return oracle::expect_image(image.shape[1], image.shape[0], image.numbers, errors.numbers,
                                    truth.numbers, o);
    }
    throw Unusable("'" + check + "': no such check");
}

}  // namespace

int main(int count, char** arguments) {
    const std::string first = count > 1 ? arguments[1] : "--help";
    if (first == "--help" || first == "-h") {
        std::fputs(usage, stdout);
        return count > 1 ? 0 : 2;
    }
    try {
        const Command command = parsed(count, arguments);
        if (command.words.empty()) throw Unusable("which check?");
        const oracle::Verdict v = verdict_of(command);
        std::printf("%s: %s\n", v.pass ? "passed" : "refused", v.text.c_str());
        return v.pass ? 0 : 1;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "oracle: %s; oracle --help lists checks and options\n", e.what());
        return 2;
    }
}
