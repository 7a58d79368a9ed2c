# Penumbra.  `make help` lists what it can do.
#
# Here is what builds programs and draws pictures.  Tests, experiments and the course have their own files, included below.
CXX   ?= g++
REAL  ?= double
TREE  ?= wide
ARCH  ?= native
SIZE  ?=

# Unused names warn, but do not fail the build.
UNUSED   ?= parameter variable function but-set-variable but-set-parameter label local-typedefs
CLANG    := $(filter clang,$(shell $(CXX) --version 2>/dev/null))
# Of -march=native clang 19 says on processors with AVX10 that it contradicts itself.
QUIET    := $(if $(CLANG),-Wno-unknown-warning-option -Wno-invalid-feature-combination)
HOMEBREW := $(addprefix -idirafter ,$(addsuffix /include,$(shell brew --prefix 2>/dev/null)))
# Which modules the core includes, by eleven files: tree.h, choice.h, prepare.h, near_misses.h, files.h, mesh.h, scene_file.h, options.h, plan.h,
# render.h, penumbra.cpp.  All others name what they need.
WITH     := $(if $(filter wide,$(TREE)),-DTREE_WIDE) $(if $(wildcard src/many),-DWITH_MANY) $(if $(wildcard src/mesh),-DWITH_MESH) \
            $(if $(wildcard src/check),-DWITH_CHECK) $(if $(wildcard src/keep),-DWITH_KEEP) $(if $(wildcard src/unseen),-DWITH_UNSEEN) \
            $(if $(wildcard src/replay),-DWITH_REPLAY) $(if $(wildcard src/show),-DWITH_SHOW)
# Fused multiply-adds only where the code says std::fma: contraction makes edge functions leak.
# Nobody asks errno about a root: loops that take roots run in vectors.
FLAGS    := -std=c++20 -march=$(ARCH) -ffp-contract=off -fno-math-errno -pthread -DREAL=$(REAL) $(WITH) -Isrc -MMD -MP \
            -Wall -Wextra -Wpedantic -Wshadow -Werror $(UNUSED:%=-Wno-error=unused-%) $(QUIET) $(HOMEBREW)
SANITISE := -O1 -g -D_GLIBCXX_ASSERTIONS -fsanitize=address,undefined -fno-sanitize-recover=all
# A program is one file, and GCC stops inlining when a file has grown by 40 %: paths took 1.13 times as long.
INLINE   := $(if $(CLANG),,--param inline-unit-growth=300)
OPTIMISE := $(if $(SAN),$(SANITISE),$(if $(DEBUG),-Og -g -D_GLIBCXX_ASSERTIONS,-O3 $(INLINE)))
VARIANT  := $(if $(SAN),-san,$(if $(DEBUG),-debug))
PLAIN    := $(if $(filter plain,$(TREE)),-plain)
SUFFIX   := $(if $(filter float,$(REAL)),-float)$(PLAIN)$(VARIANT)
OBJECTS  := build/$(notdir $(lastword $(CXX)))-$(REAL)$(PLAIN)$(VARIANT)$(if $(filter-out native,$(ARCH)),-$(ARCH))
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

.PHONY: all gallery penumbra programs clean help stb packages always
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
# that is interrupted leaves what it has in out/unfinished/.  Only who asks for a picture asks for its parts, by `$$`.
.SECONDEXPANSION:
out/%.json: scenes/%.scene $(PENUMBRA) $$(shell scenes/parts '$$*')  ## out/NAME.png: render scenes/NAME.scene
	@mkdir -p out/unfinished
	$(PENUMBRA) $(SIZE:%=--size %) -o out/unfinished/$*.png -o out/unfinished/$*.pfm \
	    --stats out/unfinished/$*.json $<
	@mv out/unfinished/$*.p?? out/ && mv out/unfinished/$*.json $@

out/%.png out/%.pfm: out/%.json
	@[ -e out/$*.png ] && [ -e out/$*.pfm ] || { rm $< && $(MAKE) --no-print-directory $<; }

# The mesh of scenes/mesh.scene is ours, too.
build/knot.obj: build/knot$(SUFFIX)
	build/knot$(SUFFIX) $@

# In scenes/calibration/SET a line "@@ NAME" begins a scene.
build/scenes: $(wildcard scenes/calibration/*)  ## files of the scenes of make calibration: build/scenes/hard/bulb.scene
	@rm -rf $@ $@.new && mkdir -p $(^:scenes/calibration/%=$@.new/%)
	@awk '$$1 == "@@" { close(file); file = FILENAME "/" $$2 ".scene"; sub(/^scenes.calibration/, "$@.new", file); next } \
	    { print >file }' $^
	@mv $@.new $@

clean:  ## remove build/ and out/
	rm -rf build out

help:  ## show this help
	@echo "make TARGET [CXX=g++|clang++] [REAL=double|float] [TREE=wide|plain] [DEBUG=1] [SAN=1] [SIZE=WxH] [ARCH=native]"
	@echo "  variants stand beside build/penumbra: build/penumbra-float, -plain, -debug, -san"
	@awk -F '  ## ' '/^[a-z].*  ## / { t = $$1; sub(/[: ].*/, "", t); if (t ~ /^out/) { t = "out/NAME.png"; sub(/^[^:]*: /, "", $$2) } printf "  %-14s %s\n", t, $$2 }' $(filter-out %.d,$(MAKEFILE_LIST))

# ---- Building ------------------------------------------------------------------------------------

# Variants keep their objects apart but share build/: copy only what differs.
build/%$(SUFFIX): $(OBJECTS)/%.exe always
	@cmp -s $< $@ || cp $< $@

# Who asks for build/penumbra with DEBUG=1 gets build/penumbra-debug, and is told.
ifneq ($(SUFFIX),)
PLAIN_NAMES := $(patsubst %,build/%,$(APPS) $(LABS) oracle-campaign oracle)
.PHONY: $(PLAIN_NAMES)
$(PLAIN_NAMES): %: %$(SUFFIX)
	@echo "this variant is $<; $@ is as it was"
endif

# No two programs have the same name.
$(APPS:%=$(OBJECTS)/%.exe): $(OBJECTS)/commit.o
	$(CXX) $(LINK) -o $@ $^

# What --version names.  It is linked, so that no program is compiled again after a commit.
$(OBJECTS)/commit.o: always
	@mkdir -p $(@D); echo 'namespace penumbra { const char* commit() { return "$(or $(shell git -C "$(or $(SOURCE),.)" describe --always --dirty 2>/dev/null),unknown commit)"; } }' >$@.new; \
	    cmp -s $@.new $(@:.o=.cpp) || { mv $@.new $(@:.o=.cpp) && $(CXX) -c -o $@ $(@:.o=.cpp); }
$(foreach cpp,$(RENDERERS),$(eval $(OBJECTS)/$(basename $(notdir $(cpp))).exe: $(patsubst src/%.cpp,$(OBJECTS)/%.o,$(cpp))))

$(LABS:%=$(OBJECTS)/%.exe): $(OBJECTS)/%.exe: $(OBJECTS)/labs/%.o
	$(CXX) $(LINK) -o $@ $^ $(LIBRARIES)

$(OBJECTS)/%.o: src/%.cpp Makefile | stb
	@mkdir -p $(@D)
	$(CXX) $(FLAGS) $(OPTIMISE) -c -o $@ $<

-include $(wildcard $(OBJECTS)/*.d $(OBJECTS)/*/*.d)

# ---- Packages: stb_image_write for programs, and doctest for tests, from the system ---------------

stb:      NEEDED := libstb-dev stb/stb_image_write.h
packages: NEEDED := doctest-dev doctest/doctest.h
packages: stb
stb packages:
	@CXX='$(CXX)' FLAGS='$(HOMEBREW)' src/packages $(NEEDED)

# ---- The rest, each where its files are ------------------------------------------------------------

-include tests/tests.mk
-include src/labs/labs.mk
-include src/web/web.mk
-include src/course/classroom.mk
-include src/book/book.mk
