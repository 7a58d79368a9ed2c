# web/web.mk  5  the renderer in a browser: modules by Debian's clang for wasm32-wasi, and pages; students' Makefile has it, too
.PHONY: web web-packages
WEB_PACKAGES := clang-19 lld-19 libclang-rt-19-dev-wasm32 libc++-19-dev-wasm32
# Exceptions end the instance (web.cpp).  Machines whose fma may round twice take software.wasm.
WEB_FLAGS    := $(filter-out -M% -march% -pthread -DWITH_KEEP $(QUIET) $(HOMEBREW),$(FLAGS)) --target=wasm32-wasi -iquote build/web/instead \
                -fignore-exceptions -fno-rtti -msimd128 -D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_GETPID \
                -O3 -mexec-model=reactor -Wl,--strip-all
FUSED        := -mrelaxed-simd -fno-builtin-fma -fno-builtin-fmaf
MODULES_OF_WEB := $(patsubst %,build/web/%$(SUFFIX).wasm,fused software)

web: $(MODULES_OF_WEB) $(if $(SUFFIX),,build/web/figure.js build/web/scenes.js build/web/playground.html)  ## the renderer in a browser: build/web/playground.html

build/web/fused$(SUFFIX).wasm: WEB_FLAGS += $(FUSED)
web-packages:
	@LC_ALL=C dpkg -s $(WEB_PACKAGES) >/dev/null 2>&1 || { echo "penumbra: packages are missing; run: sudo apt-get install -y $(WEB_PACKAGES)" >&2; exit 1; }

build/web/instead/text/files.h: src/web/files.h
	@mkdir -p $(@D) && cp $< $@
$(MODULES_OF_WEB): src/web/web.cpp build/web/instead/text/files.h src/web/web.mk Makefile | web-packages
	clang++-19 $(WEB_FLAGS) -MMD -MP -MF $@.d -MT $@ -o $@ $<
-include $(wildcard build/web/*.d)

# Pages open from a disk, where they may load no module: it is inlined.
build/web/figure.js: $(MODULES_OF_WEB) src/web/renderer.js src/web/figure.js
	@{ echo 'var penumbra = globalThis.penumbra ?? {}; penumbra.modules = {'; \
	    for module in $(MODULES_OF_WEB); do name=$${module##*/}; \
	        echo "'$${name%%[.-]*}': '$$(gzip -9nc $$module | base64 | tr -d '\n')',"; done; \
	    echo '};'; cat src/web/renderer.js src/web/figure.js; } >$@

# Texts as JavaScript writes them, by their names.
as_members = for file in $(1); do printf '"%s": `' "$$file"; sed 's/[`$$\\]/\\&/g' $$file; echo '`,'; done
build/web/scenes.js: $(wildcard scenes/*.scene scenes/*.obj scenes/*.mtl) $(if $(wildcard src/labs/knot.cpp),build/knot.obj)
	@mkdir -p $(@D)
	@{ echo 'var penumbra = globalThis.penumbra ?? {}; penumbra.files = {'; $(call as_members,$^); echo '};'; \
	    echo 'penumbra.scenes = Object.fromEntries(Object.entries(penumbra.files).filter(([name]) => name.endsWith(".scene"))'; \
	    echo '    .map(([name, text]) => [name.slice("scenes/".length, -".scene".length), text]));'; } >$@

build/web/playground.html: src/web/playground.html
	@mkdir -p $(@D) && cp $< $@
