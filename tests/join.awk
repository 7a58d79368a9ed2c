# join.awk  joins many .cpp files into one unit: all headers that they include, then each file in its own namespace
#
# Every header is included before, and once, so that the files' own includes have no effect.  With -v programs=1 the
# unit is a program that runs the main of the file in its own name: build/merge-test runs that of merge.cpp.
FNR == 1 { file[++files] = FILENAME }
/^#include [<"]/ && !seen[$2]++ { if ($2 ~ /^</) print; else header[++headers] = $0 }
END {
    if (files == 1) headers = 0  # a single file comes as it is
    for (i = 1; i <= headers; ++i) print header[i]
    if (programs) print "#define main main_of_it"
    for (i = 1; i <= files; ++i) {
        name = file[i]
        gsub(/.*\/|\.cpp$/, "", name)
        print (files > 1 ? "namespace unit_" name " {\n" : "") "#include \"" file[i] "\"" (files > 1 ? "\n}" : "")
        mains = mains "    if (name == \"" name "\") return unit_" name "::main_of_it(argc, argv);\n"
    }
    if (programs) print "#undef main\nint main(int argc, char** argv) {\n    std::string name = argv[0];\n" \
                        "    name = name.substr(name.rfind('/') + 1);\n    name = name.substr(0, name.find('-'));\n" mains \
                        "    return 127;\n}"
}
