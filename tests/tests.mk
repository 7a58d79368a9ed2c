# tests.mk  builds and runs the tests, and what checks them: mutants, fuzzers, other compilers, layers
.PHONY: told test test-all test-everywhere test-farm mutants soak fuzz oracle-campaign extremes core freestanding layers alone editors read programs-to-test

RULES := Makefile tests/tests.mk
TESTS := $(patsubst tests/%.cpp,%,$(wildcard tests/*/*_test.cpp))
SUITE := $(OBJECTS)/all-tests
# What a student does not wait for: tests of the course, of experiments, of the oracle's power, of make and its tools,
# and those that repeat runs, or read huge files, to see what is rare.
space := $() $()
LATER := course/% labs/% oracle/% fuzz/% web/% radiosity/walks% text/scene_file_bounds% \
         $(foreach t,cmake crowds faults from_blender how_to_add makefile memory parts radiosity_program resume runner scripts stopping,\
             whole/$t_test)

test test-all: packages  ## test the renderer, in layer order; ONLY=bvh: tests of bvh.h; ALL=1: also above a failing layer
	@exec env LAYERS='$(LAYERS)' TESTS='$(OBJECTS)/tests' MAKE='$(MAKE)' LOGS=build/logs$(SUFFIX) PROGRAM_SUFFIX=$(SUFFIX)-test ALL=$(ALL) \
	    LATER='$(if $(filter test,$@),$(subst $(space),|,$(subst %,,$(strip $(LATER)))))' LIMIT=$(if $(SAN)$(DEBUG),10) tests/run $(ONLY)
test-all:  ## also test course, experiments and oracle, as CI does

test-everywhere: packages build/knot.obj  ## compare the bits of all compilers, C++ libraries and processors (15 minutes); ONLY='clang++ -O2'
	@FLAGS="$(filter-out -M% -W% -march% -DREAL%,$(FLAGS))" tests/everywhere $(if $(ONLY),'$(ONLY)')

mutants: packages  ## plant every mutant of tests/mutants/: a test must detect it; ONLY=bvh: those of bvh.h
	@CXX="$(CXX)" FLAGS="$(filter-out -M% -W%,$(FLAGS)) -Itests -w -D_GLIBCXX_ASSERTIONS" tests/mutants/run $(if $(ONLY),--only "$(ONLY)") $(MUTANT_FLAGS)

soak: $(if $(FAULTS),$(PENUMBRA),$(SUITE))  ## run the random tests with fresh seeds for 10 minutes; FAULTS=1: renders under faults, for an hour; SECONDS=60
	@CXX='$(CXX)' tests/soak $(if $(FAULTS),--faults $(PENUMBRA),$(SUITE)) $(SECONDS)

fuzz: build/fuzz/fuzz$(SUFFIX) build/scenes  ## fuzz files, options and small scenes with libFuzzer, for 10 minutes; SECONDS=60: shorter
	@tests/fuzz/run $< $(SECONDS)

# Whatever CXX is: no other compiler has it.
FUZZ_CXX   ?= clang++
FUZZ_FLAGS := $(SANITISE) -fsanitize=fuzzer
build/fuzz/fuzz$(SUFFIX): tests/fuzz/fuzz.cpp $(RULES) | packages
	@mkdir -p $(@D)
	@echo 'extern "C" int LLVMFuzzerTestOneInput() { return 0; }' | \
	    $(FUZZ_CXX) $(FUZZ_FLAGS) -x c++ -o $@ - 2>/dev/null || \
	    { echo "penumbra: make fuzz needs clang++ and its libFuzzer; run: sudo apt-get install clang libclang-rt-14-dev" >&2; exit 1; }
	$(FUZZ_CXX) $(FLAGS) $(FUZZ_FLAGS) -Itests -MF $@.d -o $@ $<
-include $(wildcard build/fuzz/*.d)

test-farm: build/penumbra build/merge build/compare  ## test farms on a real Slurm and GNU parallel, installed and removed (10 minutes); CASE=slurm_killed
	@tests/farm/run $(CASE)

oracle-campaign: build/oracle-campaign$(SUFFIX)  ## false positives of the oracle: 600 correct codes, 100 seeds (100 minutes); SEEDS=5, ONLY=GGX: into out/
	@mkdir -p out
	build/$@$(SUFFIX) $(if $(SEEDS),--seeds $(SEEDS)) $(if $(ONLY),--only '$(ONLY)') \
	    --report $(if $(SEEDS)$(ONLY),out,reference)/oracle-campaign.md

# One file to copy, from sources that read downwards; it is written only if it changes.
ORACLE := $(patsubst %,tests/oracle/%.h,checks numbers host hints pictures)
%/oracle.h: $(ORACLE)
	@{ echo '// oracle/oracle.h  the oracle in one file to copy: make writes it, from $(notdir $(ORACLE))' && \
	    awk '/^#pragma once/ && n++ || /^#include "/ { next } 1' $(ORACLE); } >$@.new
	@cmp -s $@.new $@ && rm $@.new || mv $@.new $@

# They lie beside the oracle, and include it alone.  build/oracle checks arrays in files.
$(OBJECTS)/oracle-campaign.exe: tests/oracle/campaign.cpp
$(OBJECTS)/oracle.exe: tests/oracle/arrays.cpp
$(OBJECTS)/oracle-campaign.exe $(OBJECTS)/oracle.exe: tests/oracle/oracle.h $(RULES)
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) -Itests $(OPTIMISE:-O3=-O2) -MF $(@:.exe=.d) -MT $@ -o $@ $(filter %.cpp,$^)

extremes:  ## numerical robustness: errors at the extremes, double and float, into reference/extremes.md (2 minutes)
	@for real in double float; do \
	    $(MAKE) --no-print-directory REAL=$$real build/extremes-$$real.rows || exit 1; done
	@paste build/extremes-double.rows build/extremes-float.rows | bash src/labs/extremes

# In the order of the table; exit status 1: a row is red, which the table shows.
EXTREMES := scene light world sums
build/extremes-$(REAL).rows: $(EXTREMES:%=$(OBJECTS)/tests/whole/extremes_%_test.o) $(OBJECTS)/tests/main.o always
	$(CXX) $(LINK) -o $(OBJECTS)/extremes $(filter %.o,$^)
	@rm -f $@; for part in $(EXTREMES); do \
	    EXTREMES=$@ $(OBJECTS)/extremes -sf="*extremes_$${part}_test.cpp" >$@.log || [ $$? = 1 ] || \
	        { cat $@.log; exit 1; }; done

# ---- Layers --------------------------------------------------------------------------------------

# Folders by layer; those of one layer do not know each other.  Programs (.cpp) stand above app.  Tests may include all of
# their folder and of those below, of src and of tests, and the oracle; so may src/course, where students write tests.
LAYERS := base:0 world:1 wide:2 many:2 path:2 film:3 text:4 mesh:5 check:5 keep:5 unseen:5 replay:5 app:6 show:7 web:7 shadow:7 voronoi:7 radiosity:8 labs:9 course:9 book:9 \
          oracle:10 whole:10 faults:10 fuzz:10
# The core names no module, but in eleven files: which tree, which choice of lights (two), what films know of near misses, whether files are durable, meshes read, scenes checked, paths
# replayed, films kept, whether light may be unseen, and pictures shown.  Nor do tests of the core.  A module's program stands above the app.
LECTURE := base world path film
CORE    := $(LECTURE) text app
MODULES := wide many mesh check keep unseen replay show web shadow voronoi radiosity
DOORS   := world/tree.h:wide world/choice.h:many world/prepare.h:many film/near_misses.h:unseen text/files.h:keep text/mesh.h:mesh text/scene_file.h:check app/options.h:replay app/render.h:keep app/plan.h:unseen app/penumbra.cpp:show
# Of a folder that is named here, a module includes these headers alone.
NEEDS   := wide:world/shapes.h

# In a folder that has nothing else: the core must not miss what it does not name.
core: stb  ## the core alone: compile the renderer without any module, and count its lines
	@rm -rf build/core && mkdir -p build/core/src && cp -r $(CORE:%=src/%) build/core/src
	$(CXX) $(filter-out -M% $(WITH) -Isrc,$(FLAGS)) -Ibuild/core/src -O1 -o build/core/penumbra build/core/src/app/penumbra.cpp
	build/core/penumbra --size 32x16 --spp 4 --quiet -o build/core/cornell.png scenes/cornell.scene
	@echo "$$(cat $(CORE:%=src/%/*) | wc -l) lines of core: $(CORE)"

# Debian's clang compiles it for wasm32-wasi, as for a browser; Node.js runs it.
WASI_PACKAGES := clang-19 lld-19 libclang-rt-19-dev-wasm32 libc++-19-dev-wasm32 nodejs
WASI_FLAGS     = $(filter-out -M% -march% -pthread $(WITH) $(QUIET),$(FLAGS)) --target=wasm32-wasi -fno-exceptions -fno-rtti
RUN_WASI      := const {WASI} = require("wasi"), wasi = new WASI({version: "preview1"}); \
    WebAssembly.instantiate(require("fs").readFileSync(process.argv[1]), {wasi_snapshot_preview1: wasi.wasiImport}) \
        .then(made => wasi.start(made.instance))
freestanding:  ## the lecture without modules, threads, files, exceptions: compile it for wasm32-wasi, compare its bits
	@missing=$$(LC_ALL=C dpkg -s $(WASI_PACKAGES) 2>&1 >/dev/null | grep -E 'not (installed|found)'); \
	    [ -z "$$missing" ] || { echo "make freestanding: skipped:" $$missing; exit; }; set -e; mkdir -p build; \
	    clang++-19 $(WASI_FLAGS) -O1 -DFREESTANDING -o build/lecture.wasm tests/film/lecture_test.cpp; \
	    $(CXX) $(filter-out -M% $(WITH),$(FLAGS)) -O1 -DFREESTANDING -o build/lecture tests/film/lecture_test.cpp; \
	    build/lecture >build/lecture.here; node --no-warnings -e '$(RUN_WASI)' build/lecture.wasm >build/lecture.there; \
	    cmp build/lecture.here build/lecture.there; echo "the lecture draws the same bits without threads, files and exceptions"

# For tests/modules: compilers read all programs of this machine that there are, and write none.
read: OPTIMISE := -fsyntax-only
read: $(patsubst src/%.cpp,$(OBJECTS)/%.o,$(filter-out src/web/%,$(wildcard src/*/*.cpp)))

layers:  ## check that every file includes only from layers below
	@LAYERS='$(LAYERS)' LECTURE='$(LECTURE)' CORE='$(CORE)' MODULES='$(MODULES)' DOORS='$(DOORS)' NEEDS='$(NEEDS)' tests/layers

alone: $(OBJECTS)/std.h.gch | packages  ## every test compiles alone, not only beside others (2 minutes)
	@printf '%s\n' tests/*/*_test.cpp | xargs -P2 -I{} $(CXX) $(filter-out -M%,$(FLAGS)) $(TEST_OPTIMISE) -Itests \
	    -include $(OBJECTS)/std.h -fsyntax-only {} && echo "every test compiles alone"

# It asks clangd about one line: elsewhere it would try all that an editor asks.
editors:  ## clangd, which editors ask, finds no error in a header of the lecture; ONLY='src/*/*.h tests/*/*.h': in these
	@command -v clangd >/dev/null || { echo "make editors: skipped: no clangd"; exit; }; \
	    for header in $(or $(ONLY),$(LECTURE:%=src/%/*.h)); do \
	        said=$$(clangd --check=$$header --check-lines=1 2>&1) || \
	            { echo "$$header: $$(echo "$$said" | sed -n 's/^E[^]]*] //p')"; bad=1; }; \
	    done; [ -z "$$bad" ] && echo "clangd finds all that these headers include"

# ---- Building ------------------------------------------------------------------------------------

# Most tests take longer to compile than to run; these compute much.  Bounds of vectors are checked.
HEAVY := app/render course/my_tests labs/cube labs/indirect_paths oracle/arrays oracle/mistakes oracle/oracle path/pathtracer \
         radiosity/mesh radiosity/particles radiosity/shooting radiosity/transfer radiosity/walks shadow/estimates \
         shadow/shadow voronoi/voronoi voronoi/weights whole/closed_forms wide/wide_bvh world/bsdf world/bvh world/shapes
HEAVY := $(HEAVY:%=%_test)
TEST_OPTIMISE  := $(OPTIMISE:-O3=-Og) -D_GLIBCXX_ASSERTIONS
HEAVY_OPTIMISE := $(OPTIMISE:-O3=-O1) -D_GLIBCXX_ASSERTIONS
$(OBJECTS)/tests/% $(OBJECTS)/std.h.gch: OPTIMISE := $(TEST_OPTIMISE)
$(HEAVY:%=$(OBJECTS)/tests/%.o) $(OBJECTS)/tests/%-heavy.exe $(OBJECTS)/programs.exe: OPTIMISE := $(HEAVY_OPTIMISE)

# By name, a test is a program of its own.  Together they are compiled in few units, which takes a third of the time: one
# for all that compute much in the folders of TOGETHER, one for all others there, and a few for every other folder; ALONE,
# those that others must not see.
TOGETHER := world wide many mesh path film text check keep unseen app show shadow voronoi radiosity whole
ALONE    := oracle/hosts_test
FOLDER   = $(patsubst %/,%,$(dir $1))
SHARED   = $(if $(filter $(TOGETHER),$(FOLDER)),core,$(FOLDER))$(if $(filter $(LATER),$1),-later)$(if $(filter $(HEAVY),$1),-heavy)
UNIT     = $(OBJECTS)/tests/$(if $(filter $(ALONE),$1),$1-alone,$(SHARED))
IN_ORDER := $(foreach f,$(TOGETHER),$(filter $f/%,$(TESTS))) $(filter-out $(TOGETHER:%=%/%),$(TESTS))
UNITS    := $(sort $(foreach t,$(TESTS),$(call UNIT,$t)))
$(foreach t,$(IN_ORDER),$(eval IN_$(call UNIT,$t) += $t))
$(foreach t,$(TESTS),$(eval $(OBJECTS)/tests/$t.run: $(if $(JOINED),$(call UNIT,$t),$(OBJECTS)/tests/$t).exe))

# Tells tests/run, which listens at 9, what is built.  It does not wait until make has begun with all else, so a unit
# that is compiled, or cannot be, tells it of its tests; but those that run programs wait for these.
TELL = { echo $1 >&9; } 2>/dev/null || :
$(TESTS:%=$(OBJECTS)/tests/%.run): always
	@$(call TELL,$(@:$(OBJECTS)/tests/%.run=%) $(filter %.exe,$^))

$(UNITS:%=%.exe): %.exe: $(OBJECTS)/tests/main.o tests/join.awk $(RULES)
	@mkdir -p $(@D)
	@awk -f tests/join.awk $(IN_$*:%=tests/%.cpp) >$*.cpp
	@$(CXX) $(FLAGS) $(OPTIMISE) -I. -Itests -fmacro-prefix-map=./= -MT $@ -c -o $*.o $*.cpp && $(CXX) $(LINK) -o $@ $*.o $< || \
	    { for test in $(IN_$*); do $(call TELL,$$test broken); done; exit 1; }
	@for test in $(filter-out $(RUNNERS),$(IN_$*)); do $(call TELL,$$test $@); done
$(foreach u,$(UNITS),$(eval $u.exe: $(IN_$u:%=tests/%.cpp)))

$(TESTS:%=$(OBJECTS)/tests/%.exe): %.exe: %.o $(OBJECTS)/tests/main.o
	$(CXX) $(LINK) -o $@ $^

$(SUITE): $(UNITS:%=%.exe)
	$(CXX) $(LINK) -o $@ $(^:.exe=.o) $(OBJECTS)/tests/main.o

# The programs that tests run are one, which goes by its name.  Images are the same, bit for bit, however it is optimised.
TESTED  := $(filter-out course/%,$(RENDERERS:src/%.cpp=%)) labs/knot
RUNNERS = $(patsubst tests/%.cpp,%,$(shell grep -lE 'build/penumbra|whole/process.h' tests/*/*_test.cpp))
ifneq ($(filter %.run,$(MAKECMDGOALS)),)
$(RUNNERS:%=$(OBJECTS)/tests/%.run): | programs-to-test
endif
programs-to-test: $(OBJECTS)/programs.exe build/knot.obj
	@for program in $(notdir $(TESTED)); do ln -f $< build/$$program$(SUFFIX)-test; done
$(OBJECTS)/programs.exe: $(TESTED:%=src/%.cpp) tests/join.awk $(RULES)
	@mkdir -p $(@D)
	@awk -v programs=1 -f tests/join.awk $(filter %.cpp,$^) >$(OBJECTS)/programs.cpp
	$(CXX) $(FLAGS) $(OPTIMISE) -I. -MF $(OBJECTS)/programs.d -MT $@ -o $@ $(OBJECTS)/programs.cpp

$(OBJECTS)/tests/%.o: tests/%.cpp $(OBJECTS)/std.h.gch $(RULES) | packages
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(OPTIMISE) -Itests -include $(OBJECTS)/std.h -c -o $@ $<

# At once, for all wait for it.
$(OBJECTS)/tests/main.o: tests/main.cpp $(RULES) | packages
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(OPTIMISE) -Itests -c -o $@ $<

# The compiler takes it for $(OBJECTS)/std.h, which need not be there.
$(OBJECTS)/std.h.gch: tests/std.h $(RULES) | packages
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(OPTIMISE) -x c++-header -o $@ $<

-include $(wildcard $(OBJECTS)/tests/*/*.d)

# ---- CMake ---------------------------------------------------------------------------------------

# CMakeLists.txt asks for these, and for the units of `make test`: a name and its words in a line.
TOLD := FLAGS LINK OPTIMISE SUFFIX TEST_OPTIMISE HEAVY_OPTIMISE
NOW  := $(foreach u,$(UNITS),$(if $(filter-out $(LATER),$(IN_$u)),$u))
told:
	@$(foreach v,$(TOLD),$(info $v $($v)))$(info PROGRAMS $(TESTED:%=src/%.cpp))$(info UNITS $(notdir $(NOW)))
	@$(foreach u,$(NOW),$(info FILES_$(notdir $u) $(IN_$u:%=tests/%.cpp))$(info OPTIMISE_$(notdir $u) $(if $(filter %-heavy,$u),$(HEAVY_OPTIMISE),$(TEST_OPTIMISE))))
