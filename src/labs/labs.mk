# labs/labs.mk  9  experiments, by `make`: their options, and what they need besides themselves
#
# Each writes its report and pictures into reference/; with --quick (QUICK=1), less of them into out/.
EXPERIMENTS := techniques estimators1d shadows radiosity_error indirect voronoi2d bench peers trade halves calibration
.PHONY: $(EXPERIMENTS) radiosity voronoi readme

techniques: $(PENUMBRA)    ## gain of BSDF sampling, Halton points and light sampling on coursework (10 minutes)
estimators1d:              ## four estimators of a shadowed integral in 1D (a minute)
shadows: build/shadow$(SUFFIX)  ## four estimators of direct light on images (5 minutes)
voronoi2d:                 ## integrate functions by Voronoi cells; FULL=1: 10 000 trials
radiosity:                 ## illumination maps by shooting and by particle tracing (20 minutes)
radiosity_error:           ## true errors of illumination maps over those asked for (10 minutes)
indirect: $(PENUMBRA) build/radiosity$(SUFFIX)  ## final gathering, compared with whole paths (20 minutes)
voronoi:                   ## weight samples of pixels by Voronoi cells (3 minutes; FULL=1: 4096 samples, 45)
bench: build/knot.obj       ## rays per second, compared with Embree (libembree-dev); ARCHS="x86-64 native": by each set of instructions
peers: $(PENUMBRA)         ## efficiency, compared with Cycles (blender; 5 minutes); SEEDS=5: more renders
trade: $(PENUMBRA) build/penumbra-float$(VARIANT) build/knot.obj  ## error over time for every setting, and a page to choose (30 minutes; FULL=1: 4 hours)
halves: $(PENUMBRA) build/knot.obj  ## efficiency of two halves with weights (30 minutes; FORMER=PROGRAM: compare with a former penumbra)
calibration: $(PENUMBRA) build/knot.obj build/scenes  ## calibration of the error estimate (3 hours; SEEDS=4: 1 hour)

voronoi2d: LAB_FLAGS := $(if $(FULL),--trials 10000)
voronoi: LAB_FLAGS := $(if $(FULL),--most 4096)
trade: LAB_FLAGS := $(if $(FULL),--full)
halves: LAB_FLAGS := $(if $(FORMER),--former $(FORMER))
peers calibration: LAB_FLAGS := $(if $(SEEDS),--seeds $(SEEDS))
ifneq ($(ARCHS),)
bench:
	@for arch in $(ARCHS); do $(MAKE) --no-print-directory ARCHS= ARCH=$$arch bench || exit 1; done
endif
$(filter-out $(if $(ARCHS),bench),$(EXPERIMENTS)): %: build/%$(SUFFIX)
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

readme: $(PENUMBRA) build/radiosity$(SUFFIX) build/readme$(SUFFIX)  ## write the tables of options and statements into reference/
	build/readme$(SUFFIX)

# bench.cpp asks for the same header in the same way.
$(OBJECTS)/bench.exe: LIBRARIES = $(shell printf '\043include <embree3/rtcore.h>\n' | \
                                          $(CXX) -x c++ -fsyntax-only - 2>/dev/null && echo -lembree3)
