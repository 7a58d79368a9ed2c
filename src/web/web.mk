# web/web.mk  5  the renderer in a browser: modules by Debian's clang for wasm32-wasi, and pages
.PHONY: web web-packages
WEB_PACKAGES := clang-19 lld-19 libclang-rt-19-dev-wasm32 libc++-19-dev-wasm32
# Exceptions end the instance (web.cpp).  Machines whose fma may round twice take software.wasm.
WEB_FLAGS    := $(filter-out -M% -march% -pthread -DWITH_KEEP $(QUIET) $(HOMEBREW),$(FLAGS)) --target=wasm32-wasi -iquote build/web/instead \
                -fignore-exceptions -fno-rtti -msimd128 -D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_GETPID \
                -O3 -mexec-model=reactor -Wl,--strip-all
FUSED        := -mrelaxed-simd -fno-builtin-fma -fno-builtin-fmaf
MODULES_OF_WEB := $(patsubst %,build/web/%$(SUFFIX).wasm,fused software)

web: $(MODULES_OF_WEB)  ## the renderer in a browser: two WebAssembly modules in build/web/

build/web/fused$(SUFFIX).wasm: WEB_FLAGS += $(FUSED)
web-packages:
	@LC_ALL=C dpkg -s $(WEB_PACKAGES) >/dev/null 2>&1 || { echo "penumbra: packages are missing; run: sudo apt-get install -y $(WEB_PACKAGES)" >&2; exit 1; }

$(MODULES_OF_WEB): src/web/web.cpp src/web/files.h src/web/web.mk Makefile | web-packages
	@mkdir -p build/web/instead/text && cp src/web/files.h build/web/instead/text/
	clang++-19 $(WEB_FLAGS) -MMD -MP -MF $@.d -MT $@ -o $@ $<
-include $(wildcard build/web/*.d)
