# Penumbra.  `make help` lists what it can do.
CXX   ?= g++
REAL  ?= double
TREE  ?= wide
ARCH  ?= native
SIZE  ?=

# What is begun and does not yet use all it has gets a warning, and no error.
UNUSED   ?= parameter variable function but-set-variable but-set-parameter label local-typedefs
CLANG    := $(filter clang,$(shell $(CXX) --version 2>/dev/null))
# Of -march=native clang 19 says on processors with AVX10 that it contradicts itself.
QUIET    := $(if $(CLANG),-Wno-unknown-warning-option -Wno-invalid-feature-combination)
HOMEBREW := $(addprefix -idirafter ,$(addsuffix /include,$(shell brew --prefix 2>/dev/null)))
# Fused multiply-adds only where the code says std::fma: contraction makes edge functions leak.
# Nobody asks errno about a root: loops that take roots run in vectors.
FLAGS    := -std=c++20 -march=$(ARCH) -ffp-contract=off -fno-math-errno -pthread -DREAL=$(REAL) $(if $(filter wide,$(TREE)),-DTREE_WIDE) -Isrc -MMD -MP \
            -Wall -Wextra -Wpedantic -Wshadow -Werror $(UNUSED:%=-Wno-error=unused-%) $(QUIET) $(HOMEBREW)
SANITISE := -O1 -g -D_GLIBCXX_ASSERTIONS -fsanitize=address,undefined -fno-sanitize-recover=all
# A program is one file, and GCC stops inlining when a file has grown by 40 %: paths took 1.13 times as long.
INLINE   := $(if $(CLANG),,--param inline-unit-growth=300)
OPTIMISE := $(if $(SAN),$(SANITISE),$(if $(DEBUG),-Og -g -D_GLIBCXX_ASSERTIONS,-O3 $(INLINE)))
VARIANT  := $(if $(SAN),-san,$(if $(DEBUG),-debug))
PLAIN    := $(if $(filter plain,$(TREE)),-plain)
SUFFIX   := $(if $(filter float,$(REAL)),-float)$(PLAIN)$(VARIANT)
OBJECTS  := build/$(notdir $(lastword $(CXX)))-$(REAL)$(PLAIN)$(VARIANT)
LINK     := -pthread $(if $(SAN),$(SANITISE))

ifeq ($(filter double float,$(REAL)),)
  $(error REAL is double or float, not '$(REAL)')
endif
ifeq ($(filter wide plain,$(TREE)),)
  $(error TREE is wide or plain, not '$(TREE)')
endif
ifeq ($(MAKELEVEL)$(filter -j%,$(MAKEFLAGS)),0)
  MAKEFLAGS += -j$(shell nproc 2>/dev/null || sysctl -n hw.ncpu 2>/dev/null || echo 2)
endif

# A program is a .cpp of its own name; those of the core and of the modules render.
RENDERERS := $(wildcard $(patsubst %,src/%/*.cpp,app keep shadow voronoi radiosity))
LABS     := $(patsubst src/labs/%.cpp,%,$(wildcard src/labs/*.cpp))
APPS     := $(basename $(notdir $(RENDERERS)))
PENUMBRA := build/penumbra$(SUFFIX)
PROGRAMS := $(APPS:%=build/%$(SUFFIX)) $(LABS:%=build/%$(SUFFIX))
SCENES   := $(patsubst scenes/%.scene,%,$(wildcard scenes/*.scene))

.PHONY: all gallery programs test test-all test-everywhere test-farm mutants soak oracle-campaign penumbra techniques estimators1d shadows radiosity radiosity_error indirect bench \
        peers trade calibration voronoi voronoi2d extremes readme clean help layers stb packages always \
        starter starter-check mistakes handout key grade plant hunted
.DELETE_ON_ERROR:
.SECONDARY:

all: $(PENUMBRA)  ## build the renderer, render every scene into out/ (default)
	@for s in $(SCENES); do $(MAKE) --no-print-directory out/$$s.json || exit 1; done
	@scenes/gallery out $(SCENES)

gallery: $(PENUMBRA) build/knot.obj  ## large pictures with an error of 1 %: out/gallery/index.html (10 minutes)
	@mkdir -p out/gallery
	@for s in $(SCENES); do \
	    $(PENUMBRA) --size $$(awk '$$1 == "size" { print 2 * $$2 "x" 2 * $$3 }' scenes/$$s.scene) --error 1% --time 60 -o out/gallery/$$s.png \
	        -o out/gallery/$$s.pfm --stats out/gallery/$$s.json scenes/$$s.scene || exit 1; done
	@scenes/gallery out/gallery $(SCENES)

penumbra: build/penumbra  ## build the renderer alone: build/penumbra

programs: $(PROGRAMS)  ## build the renderers (build/penumbra, shadow, voronoi, radiosity) and every lab

# A picture is done when its statistics are there: those that another command wrote have none, or older ones.  A render
# that is interrupted leaves what it has in out/unfinished/.
out/%.json: scenes/%.scene $(PENUMBRA)  ## out/NAME.png: render scenes/NAME.scene
	@mkdir -p out/unfinished
	$(PENUMBRA) $(SIZE:%=--size %) -o out/unfinished/$*.png -o out/unfinished/$*.pfm \
	    --stats out/unfinished/$*.json $<
	@mv out/unfinished/$*.p?? out/ && mv out/unfinished/$*.json $@
$(shell for png in out/*.png; do [ ! "$$png" -nt "$${png%png}json" ] || echo "$${png%png}json"; done): always

out/%.png out/%.pfm: out/%.json
	@[ -e out/$*.png ] && [ -e out/$*.pfm ] || { rm $< && $(MAKE) --no-print-directory $<; }

# A picture also depends on the meshes that its scene names, and on the materials that those name: on files that are there,
# or that are made here.  The renderer refuses what is not, or does without.  Make has no names with blanks, nor some others.
PARTS := $(shell LC_ALL=C awk ' \
    function there(file) { return file !~ /\047/ && system("test -f \047" file "\047") == 0 } \
    function add(part) { if (picture part !~ /[][ \t()$$%:;=|*?~\\\043]/ && (part == "build/knot.obj" || there(part))) print picture ":" part } \
    $$1 == "mesh" { picture = FILENAME; sub(/^scenes/, "out", picture); sub(/scene$$/, "json", picture); \
                    mesh = $$2; sub(/[\043\r].*/, "", mesh); \
                    if (match($$0, /^[ \t]*mesh[ \t]+"[^"]*"/)) { split($$0, quoted, "\""); mesh = quoted[2] } \
                    if (mesh !~ /^\//) mesh = "scenes/" mesh; \
                    sub(/^scenes\/\.\.\//, "", mesh); add(mesh); \
                    folder = mesh; sub(/[^\/]*$$/, "", folder); libraries = ""; \
                    if (there(mesh)) while ((getline line < mesh) > 0) \
                        if (line ~ /^[ \t]*mtllib[ \t]/) { gsub(/\\/, "/", line); gsub(/\r/, " ", line); libraries = libraries " " line } \
                    close(mesh); \
                    n = split(libraries, library, " "); for (i = 1; i <= n; ++i) add(folder library[i]) }' \
    scenes/*.scene)
$(foreach rule,$(PARTS),$(eval $(rule)))

# The mesh of scenes/mesh.scene is ours, too.
build/knot.obj: build/knot$(SUFFIX)
	build/knot$(SUFFIX) $@

# In scenes/calibration/SET a line "@@ NAME" begins a scene.
build/scenes: $(wildcard scenes/calibration/*)  ## files of the scenes of make calibration: build/scenes/hard/bulb.scene
	@rm -rf $@ && mkdir -p $(^:scenes/calibration/%=$@/%)
	@awk '$$1 == "@@" { close(file); file = FILENAME "/" $$2 ".scene"; sub(/^scenes.calibration/, "$@", file); next } \
	    { print >file }' $^

TESTS := $(patsubst tests/%.cpp,%,$(wildcard tests/*/*_test.cpp))
SUITE := $(OBJECTS)/all-tests
# What a student does not wait for: tests of the course, of experiments, of the oracle's power, of this Makefile's tools,
# and those that repeat runs, or read huge files, to see what is rare.
space := $() $()
LATER := course/% labs/% oracle/% fuzz/% radiosity/walks% text/scene_file_bounds% $(foreach t,faults from_blender makefile memory mutants parts \
         radiosity_program resume runner stopping,whole/$t_test)

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

.PHONY: fuzz
fuzz: build/fuzz/fuzz$(SUFFIX) build/scenes  ## fuzz files, options and small scenes with libFuzzer, for 10 minutes; SECONDS=60: shorter
	@tests/fuzz/run $< $(SECONDS)

# Whatever CXX is: no other compiler has it.
FUZZ_CXX   ?= clang++
FUZZ_FLAGS := $(SANITISE) -fsanitize=fuzzer
build/fuzz/fuzz$(SUFFIX): tests/fuzz/fuzz.cpp Makefile | packages
	@mkdir -p $(@D)
	@echo 'extern "C" int LLVMFuzzerTestOneInput() { return 0; }' | \
	    $(FUZZ_CXX) $(FUZZ_FLAGS) -x c++ -o $@ - 2>/dev/null || \
	    { echo "penumbra: make fuzz needs clang++ and its libFuzzer; run: sudo apt-get install clang libclang-rt-14-dev" >&2; exit 1; }
	$(FUZZ_CXX) $(FLAGS) $(FUZZ_FLAGS) -Itests -MF $@.d -o $@ $<
-include $(wildcard build/fuzz/*.d)

test-farm: build/penumbra build/merge build/compare  ## test farms on a real Slurm and GNU parallel, installed and removed (10 minutes); CASE=slurm_killed
	@tests/farm/run $(CASE)

# Experiments: each writes its report and pictures into reference/; with --quick (QUICK=1), less of them into out/.
techniques: $(PENUMBRA)    ## gain of BSDF sampling, Halton points and light sampling on coursework (10 minutes)
estimators1d:              ## four estimators of a shadowed integral in 1D (a minute)
shadows: build/shadow$(SUFFIX)  ## four estimators of direct light on images (5 minutes)
voronoi2d:                 ## integrate functions by Voronoi cells; FULL=1: 10 000 trials
radiosity:                 ## illumination maps by shooting and by particle tracing (20 minutes)
radiosity_error:           ## true errors of illumination maps over those asked for (10 minutes)
indirect: $(PENUMBRA) build/radiosity$(SUFFIX)  ## final gathering, compared with whole paths (20 minutes)
voronoi:                   ## weight samples of pixels by Voronoi cells (3 minutes; FULL=1: 4096 samples, 45)
bench: build/knot.obj       ## rays per second, compared with Embree (libembree-dev)
peers: $(PENUMBRA)         ## efficiency, compared with Cycles (blender; 5 minutes); SEEDS=5: more renders
trade: $(PENUMBRA) build/penumbra-float$(VARIANT) build/knot.obj  ## error over time for every setting, and a page to choose (30 minutes; FULL=1: 4 hours)
halves: $(PENUMBRA)         ## efficiency of two halves with weights (30 minutes; FORMER=PROGRAM: compare with a former penumbra)
calibration: $(PENUMBRA) build/knot.obj build/scenes  ## calibration of the error estimate (3 hours; SEEDS=4: 1 hour)
oracle-campaign: build/oracle-campaign$(SUFFIX)  ## false positives of the oracle: 600 correct codes, 100 seeds (100 minutes); SEEDS=5, ONLY=GGX: into out/
	@mkdir -p out
	build/$@$(SUFFIX) $(if $(SEEDS),--seeds $(SEEDS)) $(if $(ONLY),--only '$(ONLY)') \
	    --report $(if $(SEEDS)$(ONLY),out,reference)/oracle-campaign.md
EXPERIMENTS := techniques estimators1d shadows radiosity_error indirect voronoi2d bench peers trade halves calibration
voronoi2d: LAB_FLAGS := $(if $(FULL),--trials 10000)
voronoi: LAB_FLAGS := $(if $(FULL),--most 4096)
trade: LAB_FLAGS := $(if $(FULL),--full)
halves: LAB_FLAGS := $(if $(FORMER),--former $(FORMER))
peers calibration: LAB_FLAGS := $(if $(SEEDS),--seeds $(SEEDS))
$(EXPERIMENTS): %: build/%$(SUFFIX)
	build/$@$(SUFFIX) $(if $(QUICK),--quick) $(LAB_FLAGS)
# Both precisions are measured side by side.
ifeq ($(REAL),double)
build/penumbra-float$(VARIANT): always
	@$(MAKE) --no-print-directory REAL=float $@
endif
# build/radiosity and build/voronoi are renderers.
radiosity: $(PENUMBRA) build/radiosity$(SUFFIX) build/illumination$(SUFFIX) build/illumination_cube$(SUFFIX)
	build/illumination_cube$(SUFFIX) $(if $(QUICK),--quick)
	build/illumination$(SUFFIX) $(if $(QUICK),--quick)
voronoi: $(PENUMBRA) build/voronoi$(SUFFIX) build/voronoi_weights$(SUFFIX)
	build/voronoi_weights$(SUFFIX) $(if $(QUICK),--quick) $(LAB_FLAGS)

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

readme: $(PENUMBRA) build/radiosity$(SUFFIX) build/readme$(SUFFIX)  ## write the tables of options and statements into reference/
	build/readme$(SUFFIX)

clean:  ## remove build/ and out/
	rm -rf build out

help:  ## show this help
	@echo "make TARGET [CXX=g++|clang++] [REAL=double|float] [TREE=wide|plain] [DEBUG=1] [SAN=1] [SIZE=WxH] [ARCH=native]"
	@echo "  variants stand beside build/penumbra: build/penumbra-float, -plain, -debug, -san"
	@awk -F '  ## ' '/^[a-z].*  ## / { t = $$1; sub(/[: ].*/, "", t); if ($$2 ~ /^out/) { t = "out/NAME.png"; sub(/^[^:]*: /, "", $$2) } printf "  %-14s %s\n", t, $$2 }' $(firstword $(MAKEFILE_LIST)) $(wildcard src/course/course.mk)

# ---- Building ------------------------------------------------------------------------------------

# Variants keep their objects apart but share build/: copy only what differs.
build/%$(SUFFIX): $(OBJECTS)/%.exe always
	@cmp -s $< $@ || cp $< $@

# Who asks for build/penumbra with DEBUG=1 gets build/penumbra-debug, and is told.
ifneq ($(SUFFIX),)
PLAIN_NAMES := $(patsubst %,build/%,$(APPS) $(LABS) oracle-campaign)
.PHONY: $(PLAIN_NAMES)
$(PLAIN_NAMES): %: %$(SUFFIX)
	@echo "this variant is $<; $@ is as it was"
endif

# No two programs have the same name.
$(APPS:%=$(OBJECTS)/%.exe): $(OBJECTS)/commit.o
	$(CXX) $(LINK) -o $@ $^

# What --version names.  It is linked, so that no program is compiled again after a commit.
$(OBJECTS)/commit.o: always
	@mkdir -p $(@D); echo 'const char* commit() { return "$(or $(shell git describe --always --dirty 2>/dev/null),unknown commit)"; }' >$@.new; \
	    cmp -s $@.new $(@:.o=.cpp) || { mv $@.new $(@:.o=.cpp) && $(CXX) -c -o $@ $(@:.o=.cpp); }
$(foreach cpp,$(RENDERERS),$(eval $(OBJECTS)/$(basename $(notdir $(cpp))).exe: $(patsubst src/%.cpp,$(OBJECTS)/%.o,$(cpp))))

$(LABS:%=$(OBJECTS)/%.exe): $(OBJECTS)/%.exe: $(OBJECTS)/labs/%.o
	$(CXX) $(LINK) -o $@ $^ $(LIBRARIES)

# It lies beside the oracle, and includes it alone.
$(OBJECTS)/oracle-campaign.exe: OPTIMISE := $(OPTIMISE:-O3=-O2)
$(OBJECTS)/oracle-campaign.exe: tests/oracle/campaign.cpp Makefile
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(OPTIMISE) -MF $(@:.exe=.d) -MT $@ -o $@ $<

# bench.cpp asks for the same header in the same way.
$(OBJECTS)/bench.exe: LIBRARIES = $(shell printf '\043include <embree3/rtcore.h>\n' | \
                                          $(CXX) -x c++ -fsyntax-only - 2>/dev/null && echo -lembree3)

# Most tests take longer to compile than to run; these compute much.  Whoever reads beyond the end of a
# vector is told so.
HEAVY := app/render labs/indirect_paths radiosity/walks shadow/estimates course/my_tests labs/cube oracle/mistakes oracle/oracle path/pathtracer radiosity/mesh radiosity/particles \
         radiosity/shooting radiosity/transfer shadow/shadow voronoi/voronoi voronoi/weights whole/closed_forms \
         wide/wide_bvh world/bsdf world/bvh world/shapes
HEAVY := $(HEAVY:%=%_test)
$(OBJECTS)/tests/%: OPTIMISE := $(OPTIMISE:-O3=-Og) -D_GLIBCXX_ASSERTIONS
$(HEAVY:%=$(OBJECTS)/tests/%.o) $(OBJECTS)/tests/%-heavy.exe $(OBJECTS)/programs.exe: OPTIMISE := $(OPTIMISE:-O3=-O1) -D_GLIBCXX_ASSERTIONS
$(OBJECTS)/std.h.gch: OPTIMISE := $(OPTIMISE:-O3=-Og) -D_GLIBCXX_ASSERTIONS

# By name, a test is a program of its own.  Together they are compiled in few units, which takes a third of the time: one
# for all that compute much in the folders of TOGETHER, one for all others there, and a few for every other folder; ALONE,
# those that others must not see.
TOGETHER := world wide mesh path film text keep unseen app shadow voronoi radiosity whole
ALONE    := oracle/hosts_test
FOLDER   = $(patsubst %/,%,$(dir $1))
UNIT     = $(OBJECTS)/tests/$(if $(filter $(ALONE),$1),$1-alone,$(if $(filter $(TOGETHER),$(call FOLDER,$1)),core,$(call FOLDER,$1))$(if $(filter $(LATER),$1),-later)$(if $(filter $(HEAVY),$1),-heavy))
UNITS := $(sort $(foreach t,$(TESTS),$(call UNIT,$t)))
$(foreach t,$(foreach f,$(TOGETHER),$(filter $f/%,$(TESTS))) $(filter-out $(TOGETHER:%=%/%),$(TESTS)),$(eval IN_$(call UNIT,$t) += $t))
$(foreach t,$(TESTS),$(eval $(OBJECTS)/tests/$t.run: $(if $(JOINED),$(call UNIT,$t),$(OBJECTS)/tests/$t).exe))

# Tells tests/run, which listens at 9, what is built.  It does not wait until make has begun with all else, so a unit
# that is compiled, or cannot be, tells it of its tests; but those that run programs wait for these.
TELL = { echo $1 >&9; } 2>/dev/null || :
$(TESTS:%=$(OBJECTS)/tests/%.run): always
	@$(call TELL,$(@:$(OBJECTS)/tests/%.run=%) $(filter %.exe,$^))

$(UNITS:%=%.exe): %.exe: $(OBJECTS)/tests/main.o tests/join.awk Makefile
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
RUNNERS := $(patsubst tests/%.cpp,%,$(shell grep -lE 'build/penumbra|whole/process.h' tests/*/*_test.cpp))
$(RUNNERS:%=$(OBJECTS)/tests/%.run): | programs-to-test
.PHONY: programs-to-test
programs-to-test: $(OBJECTS)/programs.exe build/knot.obj
	@for program in $(notdir $(TESTED)); do ln -f $< build/$$program$(SUFFIX)-test; done
$(OBJECTS)/programs.exe: $(TESTED:%=src/%.cpp) tests/join.awk Makefile
	@mkdir -p $(@D)
	@awk -v programs=1 -f tests/join.awk $(filter %.cpp,$^) >$(OBJECTS)/programs.cpp
	$(CXX) $(FLAGS) $(OPTIMISE) -I. -MF $(OBJECTS)/programs.d -MT $@ -o $@ $(OBJECTS)/programs.cpp

$(OBJECTS)/tests/%.o: tests/%.cpp $(OBJECTS)/std.h.gch Makefile | packages
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(OPTIMISE) -Itests -include $(OBJECTS)/std.h -c -o $@ $<

# At once, for all wait for it.
$(OBJECTS)/tests/main.o: tests/main.cpp Makefile | packages
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(OPTIMISE) -Itests -c -o $@ $<

# The compiler takes it for $(OBJECTS)/std.h, which need not be there.
$(OBJECTS)/std.h.gch: tests/std.h Makefile | packages
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(OPTIMISE) -x c++-header -o $@ $<

$(OBJECTS)/%.o: src/%.cpp Makefile | stb
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(OPTIMISE) -c -o $@ $<

-include $(wildcard $(OBJECTS)/*.d $(OBJECTS)/*/*.d $(OBJECTS)/tests/*/*.d)

# ---- The classroom -------------------------------------------------------------------------------

-include src/course/course.mk
JUDGES := $(patsubst tests/course/%.cpp,$(COURSE)/%,$(wildcard tests/course/judge_*.cpp))

# What the solution draws, students compare with.  They have the plain BVH.
DRAWN_BY := $(if $(filter float,$(REAL)),-float)-plain$(VARIANT)
.PHONY: drawers
drawers:
	@$(MAKE) --no-print-directory TREE=plain build/penumbra$(DRAWN_BY) build/shadow$(DRAWN_BY)

starter:  ## write the students' starter, build/starter/ and .tar.gz; WEEKS=1-3: these weeks, with earlier weeks solved
	@DRAW_SUFFIX=$(DRAWN_BY) python3 src/course/starter.py $(if $(WEEKS),--weeks '$(WEEKS)') build/starter
starter: drawers

# Students' code is compiled and run in bubblewrap alone.
grade: packages  ## grade submissions: SUBMISSIONS=FOLDER; OUT=FOLDER-grades, WEEKS=1-3, SEED=N, JOBS=2
	@$(if $(SUBMISSIONS),,echo "make grade SUBMISSIONS=FOLDER: a folder or a .tar.gz for each student" >&2; exit 2;) \
	CXX="$(CXX)" FLAGS="$(filter-out -M% -W%,$(FLAGS)) -Itests -w -O1" python3 src/course/grade.py \
	    $(if $(OUT),--out '$(OUT)') $(if $(WEEKS),--weeks '$(WEEKS)') $(if $(SEED),--seed $(SEED)) \
	    $(if $(JOBS),--jobs $(JOBS)) '$(SUBMISSIONS)'

plant:  ## write a bug hunt: a solved copy with one mutant, as build/plant/N/ and .tar.gz; M=NAME or M=random, WEEKS=1-3
	@$(if $(M),,echo "make plant M=NAME: which of tests/mutants/?  M=random draws one" >&2; exit 2;) \
	CXX='$(CXX)' SUFFIX=$(SUFFIX) DRAW_SUFFIX=$(DRAWN_BY) python3 src/course/plant.py --mutant '$(M)' $(if $(WEEKS),--weeks '$(WEEKS)') build/plant
plant: drawers

hunted: packages  ## grade a bug hunt; N=3: of the copy build/plant/3, HUNT=FILE: the submitted test
	@$(if $(and $(N),$(HUNT)),,echo "make hunted N=NUMBER HUNT=FILE: which copy, and its test?" >&2; exit 2;) \
	CXX="$(CXX)" FLAGS="$(filter-out -M% -W%,$(FLAGS)) -Itests -w -O1" python3 src/course/hunted.py 'build/plant/$(N)' '$(HUNT)'

mistakes:  ## regenerate the table of known mistakes, tests/course/mistakes.txt (half an hour)
	@CXX='$(CXX)' FLAGS='$(FLAGS)' SUFFIX=$(SUFFIX) python3 src/course/mistakes.py $(if $(EX),--only '$(EX)')
mistakes: $(JUDGES) $(JUDGES:$(COURSE)/judge_%=$(COURSE)/answers_%)

handout:  ## sheets for students as HTML, and as PDF where Chromium is installed: build/handout/index.html; PAPER=letter
	@python3 src/course/handout.py $(if $(PAPER),--paper $(PAPER)) build/handout

key:  ## for instructors: the sheets with their answers, plans of the sessions, grading: build/key/index.html; PAPER=letter
	@python3 src/course/handout.py --key $(if $(PAPER),--paper $(PAPER)) build/key

starter-check:  ## test the starter; FULL=1: each pair of stubs, too
	@CXX='$(CXX)' FLAGS='$(FLAGS)' SUFFIX=$(SUFFIX) python3 src/course/starter_check.py $(if $(FULL),--full) $(if $(DRAW),--draw '$(DRAW)')
starter-check: $(JUDGES) $(JUDGES:$(COURSE)/judge_%=$(COURSE)/answers_%)

# ---- Packages: stb_image_write for programs, and doctest for tests, from the system ---------------

stb:      NEEDED := libstb-dev stb/stb_image_write.h
packages: NEEDED := doctest-dev doctest/doctest.h
packages: stb
INSTALL     = apt-get install -y $(firstword $(NEEDED))
HAVE_HEADER = echo '\#include <$(lastword $(NEEDED))>' | $(CXX) $(HOMEBREW) -x c++ -fsyntax-only - 2>/dev/null

stb packages:
	@command -v $(firstword $(CXX)) >/dev/null || \
	    { echo "penumbra: no compiler $(CXX): install it, or say make CXX=..." >&2; exit 1; }
	@$(HAVE_HEADER) && exit 0; \
	if ! command -v apt-get >/dev/null; then \
	    echo "penumbra: install the header $(lastword $(NEEDED))" >&2; exit 1; \
	elif [ "$$(id -u)" = 0 ]; then as=; \
	elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then as="sudo -n"; \
	else \
	    echo "penumbra: a package is missing; run: sudo $(INSTALL)$(if $(filter stb,$@),  (and doctest-dev for make test))" >&2; exit 1; \
	fi; \
	echo "installing $(firstword $(NEEDED))"; \
	$$as $(INSTALL) >/dev/null 2>&1 || { $$as apt-get update && $$as $(INSTALL); } >/dev/null || \
	    { echo "penumbra: apt-get failed; run: sudo $(INSTALL)" >&2; exit 1; }; \
	$(HAVE_HEADER) || { echo "penumbra: $(firstword $(NEEDED)) is installed, but $(CXX) finds no header" >&2; exit 1; }

# ---- Layers --------------------------------------------------------------------------------------------

# Folders by layer; those of one layer do not know each other.  Programs (.cpp) stand above app.  Tests may include all of their folder
# and of those below, of src and of tests, and the oracle; so may src/course, where students write tests.
LAYERS := base:0 world:1 wide:2 path:2 film:3 text:4 mesh:5 keep:5 unseen:5 app:6 shadow:7 voronoi:7 radiosity:8 labs:9 course:9 oracle:10 whole:10 faults:10 fuzz:10
# The core names no module, but in four headers: which tree, whether meshes are read, whether films are kept, whether light may be unseen.  Nor do
# tests of the core.  A module's program stands above the app.
CORE  := base world path film text app
MODULES := wide mesh keep unseen shadow voronoi radiosity
DOORS := world/tree.h:wide text/mesh.h:mesh app/keep.h:keep app/unseen.h:unseen
# Of a folder that is named here, a module includes these headers alone.
NEEDS := wide:world/shapes.h

# In a folder that has nothing else: the core must not miss what it does not name.
.PHONY: core
core: stb  ## the core alone: compile the renderer without any module, and count its lines
	@rm -rf build/core && mkdir -p build/core/src && cp -r $(CORE:%=src/%) build/core/src
	$(CXX) $(filter-out -M% -DTREE_WIDE -Isrc,$(FLAGS)) -Ibuild/core/src -O1 -o build/core/penumbra build/core/src/app/penumbra.cpp
	build/core/penumbra --size 32x16 --spp 4 --quiet -o build/core/cornell.png scenes/cornell.scene
	@echo "$$(cat $(CORE:%=src/%/*) | wc -l) lines of core: $(CORE)"

layers:  ## check that every file includes only from layers below
	@awk -v layers='$(LAYERS)' -v core='$(CORE)' -v modules='$(MODULES)' -v doors='$(DOORS)' -v needs='$(NEEDS)' ' \
	    function set(words, of,    list, i) { split(words, list, " "); for (i in list) of[list[i]] } \
	    function folder(file) { return substr(file, 1, index(file, "/") - 1) } \
	    BEGIN { split(layers, list, " "); \
	            for (i in list) { split(list[i], pair, ":"); layer[pair[1]] = pair[2] }; \
	            set(core, in_core); set(modules, module); set(doors, door); set(needs, need); \
	            for (i in need) limited[substr(i, 1, index(i, "/"))] } \
	    FNR == 1 { name = FILENAME; sub(/^(src|tests)\//, "", name); test[name] = FILENAME ~ /^tests/; \
	               number[name] = test[name] ? 0 : $$3; \
	               if (!(folder(name) in layer)) { print FILENAME ": no such folder in LAYERS"; bad = 1 } \
	               if (!test[name] && ($$2 != name || $$3 !~ /^[0-9]+$$/ || NF < 5)) \
	                   { print FILENAME ": line 1 must say: // " name "  NUMBER  what it is"; bad = 1 } } \
	    /^#include "/ { split($$0, quoted, "\""); from[++n] = name; to[n] = quoted[2]; at[n] = FILENAME ":" FNR } \
	    END { for (i = 1; i <= n; ++i) { \
	              if (!(to[i] ~ /\//)) to[i] = folder(from[i]) "/" to[i]; \
	              f = folder(from[i]); g = folder(to[i]); \
	              if (!test[from[i]] && from[i] ~ /\.cpp$$/ && f != g && layer[f] < 7) layer_of = 7; else layer_of = layer[f]; \
	              below = f != g ? layer[g] < layer_of : test[from[i]] || number[to[i]] < number[from[i]]; \
	              if (g == "oracle" || (test[from[i]] && (g == "text" || to[i] == "app/threads.h"))) below = 1; \
	              if (f in module && from[i] ~ /\.cpp$$/ && g == "app") below = 1; \
	              if (f in in_core && g in module) below = (from[i] ":" g) in door; \
	              if (!test[from[i]] && (f ":" g "/") in limited && !((f ":" to[i]) in need)) below = 0; \
	              if (!(to[i] in number) || (test[to[i]] && !test[from[i]] && f g != "courseoracle") || !below) \
	                  { print at[i] ": " from[i] " is not above " to[i]; bad = 1 } } \
	          if (!bad) print n " includes, all downwards"; exit bad }' \
	    $(filter-out %/__pycache__ src/course/stubs,$(wildcard src/*/* tests/*/*.h tests/*/*.cpp))
