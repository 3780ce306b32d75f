# Every target installs what it needs (scripts/setup); a second run is quick.
MAKEFLAGS += --no-print-directory
ELF := target/avr-atmega328p/release/lizard.elf
# Cargo puts builds for the host into a folder with the host's name.
HOST := crates/target/$$(rustc --print host-tuple)
LIZARD := crates/target/release/lizard
-include target/toolchain.mk

# A robot other than robot.toml: make firmware ROBOT=robots/x.toml. LIZARD_ROBOT passes the path to the firmware's
# build script and to the tests.
ROBOT ?= $(LIZARD_ROBOT)
ifneq ($(ROBOT),)
# make's own functions would split a path at a space.
ROBOT_FILE := $(shell CDPATH= cd "$$(dirname '$(ROBOT)')" 2> /dev/null && ls -d "$$PWD/$$(basename '$(ROBOT)')" 2> /dev/null)
ifeq ($(ROBOT_FILE),)
$(error ROBOT=$(ROBOT) does not exist; give a file such as robots/paper.toml)
endif
export LIZARD_ROBOT := $(ROBOT_FILE)
FOR_ROBOT := --robot '$(LIZARD_ROBOT)'
endif

# All packages except the Python module and the page's build tool. The module's dependencies would enable more features
# in the other packages' dependencies, so all of them would be compiled twice. Only the page needs the build tool.
ALL := --workspace --exclude lizard-python --exclude lizard-bindgen

# The caller's settings must not reach cargo: this file names cargo's default folders, and .cargo/config.toml has the
# firmware's flags.
unexport CARGO_TARGET_DIR CARGO_BUILD_TARGET_DIR CARGO_BUILD_TARGET RUSTFLAGS CARGO_ENCODED_RUSTFLAGS RUSTC_BOOTSTRAP

# Cargo can use make's jobserver only in a rule that calls make; in other rules, cargo prints a warning.
CARGO := MAKEFLAGS= cargo

# Each of these targets has a rule of the same name with a leading dot, which does the work.
TARGETS := sim test sweep flash flash-test web web-test lint measure-test parts-test cli bench fit prove physics mutants other-robots trouble explore fuzz package code-image docs install docs-check release release-test parallel-test arduino-test python-test addresses-test desks

.PHONY: help clean firmware .firmware .gaits .simulator .tests .workspace .walks $(TARGETS) $(TARGETS:%=.%)

help: ## print this list
	@grep -E '^[a-z-]+:.*## ' Makefile | sed -E 's/^([a-z-]+):.*## /\1\t/' | expand -t 15
	@echo "firmware, sim, test, bench, prove, fit, trouble and flash take ROBOT=robots/x.toml; the default is robot.toml"

sim: ## run the firmware's walk on a simulated UNO; print a table and a drawing of its gait
test: ## run every test, on the host and on the simulated UNO
sweep: ## build the example of crates/pulses/, eight servos during serial traffic, as an .elf for the UNO
firmware: ## build the firmware for the UNO, .elf and .hex; print flash, RAM and every gait's margins
flash: ## build the firmware, write it to a UNO on USB, open its console (ravedude)
flash-test: ## test `make flash` and `lizard flash`, and their error messages, with a simulated board
web: ## build the page with the robot in the browser: web/dist, a folder for any web server
web-test: ## test the page in a real browser: walking, turning, refusals, calibration, flashing
lint: ## run rustfmt, clippy and cargo doc; warnings are errors
measure-test: ## test measurements with videos of known paths, and the identification of changed keys; VIDEOS=200 SEED=1
parts-test: ## check the files of `lizard parts` and `lizard model` with ezdxf, FreeCAD, PrusaSlicer, urdfdom and others; ONLY=grain+large
cli: ## build the host program, crates/target/release/lizard
bench: ## measure the budgets, compared with the Arduino Servo library; poses solved per second
fit: ## prove that no two parts collide in any pose that the guard accepts
prove: ## compare the guard with floating point for every pose; takes a minute or two
physics: ## compare the contact model with MuJoCo for every gait; WRITE=1 stores the results, ONE_IN=10 selects every tenth row
mutants: ## mutation tests: report mutants that no test detects; PART=board, core or kinematics; SAMPLE=60 SEED=1: random mutants and their detection rate
other-robots: ## run every test of the image with the robots in robots/ and with random valid robots; SEED=1 COUNT=10, EXCEPT=large+grain
trouble: ## fault injection: stalls, resets, supply dips and failures of a radio link at random times; SEED=1, COUNT=10000, ONLY=number of a scenario
explore: ## run the model checker: commands, resets, stalls and weak supplies in any order; STATES=10000000
fuzz: ## search for harmful bytes with libFuzzer; TARGET=console or memory, MINUTES=1
package: ## package the stand-alone crates as for a registry, and build each from its package
code-image: ## write firmware/code.hex: the firmware's code, which the program and the page contain
docs: ## write the generated pages and drawings; build the book from docs/ in out/book
install: ## install the program, its manual pages and completions into PREFIX=~/.local
docs-check: ## check that the book's values that take long to compute are up to date
release: ## build all files of a release from the current commit, in dist/; takes a while
release-test: ## build a release twice, in different folders; compare the bytes, and test each file
parallel-test: ## split long computations with GNU parallel, merge the parts, and compare the output with that of one process
arduino-test: ## compare the C++ library in arduino/, compiled as in the Arduino IDE, with the Rust engine; SERVO=folder of the Servo library
python-test: ## build the Python package's wheel, install it in target/python, test it there
addresses-test: ## check that the addresses in crates/Cargo.toml, set in a copy, appear in the program, a package, the page and the book
desks: ## build `lizard` for Linux on ARM and for Windows, run it, compare its output; check that it compiles for macOS
clean: ## remove everything that was built
	rm -rf target crates/target out dist tools/judge/node_modules web/node_modules web/tests/node_modules web/node/node_modules web/dist web/public web/generated

# scripts/setup chooses the compiler, so it runs first; then a new make reads the choice from target/toolchain.mk.
$(TARGETS):
	@scripts/setup
	@$(MAKE) .$@
firmware:
	@scripts/setup
	@$(MAKE) .gaits

# RUSTC_BOOTSTRAP enables the AVR features of a stable compiler, only for this build. The .hex is replaced atomically,
# because in .ci/run another target may read it at the same time.
.firmware:
	@RUSTC_BOOTSTRAP=1 $(CARGO) build --release
	@new=$(ELF).$$$$; avr-objcopy -O ihex -R .eeprom $(ELF) $$new && mv $$new $(ELF:.elf=.hex)
	@scripts/size $(ELF)

# The example of crates/pulses/: servos and a serial line without the robot.
.sweep:
	@RUSTC_BOOTSTRAP=1 $(CARGO) build --release --example sweep --quiet

.gaits: .firmware
	@echo
	@cat $(dir $(ELF))gaits.txt

# The port is checked first, so that a missing board is reported before the build.
.flash:
	@scripts/flash --check
	@$(MAKE) .firmware
	@scripts/setup-flash
	@scripts/flash

# Tests `make flash` and `lizard flash` with a simulated board on a pseudo terminal. The tests run in real time and
# therefore one after another.
.flash-test: .firmware
	@scripts/setup-flash
	@scripts/setup-flash-test
	@cd crates && cargo build $(ALL) --bin lizard --quiet
	@cd crates && LIZARD="$(CURDIR)/$(HOST)/debug/lizard" cargo test $(ALL) --features lizard-host-tests/flash --test flash --test flash_errors --test lizard_flash --quiet -- --test-threads=1

.web:
	@scripts/setup-web
	@scripts/build-web

# A test compares the firmware's section for robot.toml with the page's. ONLY=measure+slow runs only these files, one
# after another; EXCEPT=measure+slow omits these files.
.web-test:
	@env -u LIZARD_ROBOT $(MAKE) .firmware ROBOT=
	@scripts/setup-web --test
	@scripts/setup-book
	@scripts/build-web
	@cd crates && cargo build $(ALL) --bin lizard --quiet && cargo build -p lizard-studio --quiet
	@LIZARD=$(HOST)/debug/lizard "$$(cat target/web-node)" --test --test-concurrency=$(if $(ONLY),1,2) --test-timeout=900000 $(or $(patsubst %,web/tests/%.test.js,$(subst +, ,$(ONLY))),$(filter-out $(patsubst %,web/tests/%.test.js,$(subst +, ,$(EXCEPT))),$(wildcard web/tests/*.test.js)))

# The last line puts the program at the path that the documentation names.
.cli:
	@cd crates && cargo build --release
	@mkdir -p $(dir $(LIZARD))
	@ln -f $(HOST)/release/lizard $(LIZARD)

# The parts of the host program for a simulation, in a profile that compiles fast.
.simulator:
	@cd crates && $(CARGO) build --profile sim --no-default-features --features simulator

# Both builds run in parallel, because each has phases that use only one core.
.sim:
	@$(MAKE) -j2 .firmware .simulator
	@$(HOST)/sim/lizard sim --elf $(ELF) $(FOR_ROBOT)

# The tested packages. TESTS="-p lizard-host-tests" selects the tests that run the image.
TESTS ?= $(ALL)

# The tests are compiled in parallel with the firmware, because each build has phases that use only one core.
.tests:
	@cd crates && $(CARGO) test $(TESTS) --no-run --quiet

# The random inputs are the same in every run; PROPTEST_RNG_SEED=2 make test uses others. An input that fails a test is
# written to a folder proptest-regressions, is tried first in later runs, and should be committed.
.workspace:
	@cd crates && PROPTEST_RNG_SEED=$${PROPTEST_RNG_SEED:-1} $(CARGO) test $(TESTS) --no-fail-fast --quiet

# The tests of walking with other robots. They run in parallel with .workspace, many of whose tests wait, and their
# output is shown at the end.
WALKS := target/walks.log
.walks:
	@mkdir -p $(dir $(WALKS))
	@MAKEFLAGS= scripts/other-robots $(or $(SEED),1) $(or $(COUNT),10) walks > $(WALKS) 2>&1

# If the judge cannot be set up, its tests fail with the reason, and the other tests run.
.test:
	@scripts/setup-judge || true
	@$(MAKE) -j2 .firmware .tests
	@$(MAKE) .sweep
	$(if $(ROBOT),@$(MAKE) .workspace,@$(MAKE) -j2 -k .workspace .walks; result=$$?; cat $(WALKS); exit $$result)

# Only this target installs FreeCAD and PrusaSlicer, which are large.
.parts-test:
	@scripts/setup-parts
	@cd crates && cargo build $(ALL) --bin lizard --quiet
	@scripts/parts-test $(HOST)/debug/lizard $(patsubst %,robots/%.toml,$(subst +, ,$(ONLY)))
	@out/put-together/bin/python scripts/models-test $(HOST)/debug/lizard

.bench: .firmware .cli
	@$(LIZARD) sim bench --elf $(ELF) $(FOR_ROBOT)
	@echo
	@cd crates && cargo bench --quiet -p lizard-kinematics

.prove:
	@cd crates && cargo build $(ALL) --bin lizard --quiet
	@$(HOST)/debug/lizard prove $(FOR_ROBOT)

.fit: .cli
	@$(LIZARD) fit $(FOR_ROBOT)

# Separate from the other tests, because hundreds of videos take minutes.
.measure-test:
	@cd crates && VIDEOS=$(or $(VIDEOS),200) SEED=$(or $(SEED),1) $(CARGO) test -p lizard-video --test video -p lizard-identify --test robots --quiet -- --ignored --nocapture

# Separate from the other tests, because only this target installs MuJoCo.
.physics: .firmware
	@scripts/setup-physics
	@cd crates && cargo build $(ALL) --bin lizard --bin lizard-physics --quiet
	@$(HOST)/debug/lizard model target/physics/walk.xml --drive walk --elf $(ELF) $(FOR_ROBOT)
	@target/physics/bin/python tools/physics/judge.py target/physics/walk.xml
	@cd crates && ../$(HOST)/debug/lizard-physics $(if $(WRITE),--write,--one-in $(or $(ONE_IN),1))

# ONLY=serial.rs selects the mutants of this file.
.mutants:
	@scripts/mutants $(or $(PART),board) $(ONLY)

.other-robots: .firmware
	@scripts/other-robots $(or $(SEED),1) $(or $(COUNT),10) all $(EXCEPT)

# ONLY=4711 repeats one scenario of the seed and prints its events.
.trouble: .firmware
	@cd crates && SEED=$(SEED) COUNT=$(COUNT) ONLY=$(ONLY) $(CARGO) run -p lizard-host-tests --bin trouble --quiet

.explore:
	@cd crates && cargo run --release --quiet -p lizard-explore -- $(or $(STATES),10000000)

.fuzz:
	@for target in $(or $(TARGET),console memory); do scripts/fuzz $$target $(or $(MINUTES),1) || exit 1; done

.docs: .firmware .cli
	@$(LIZARD) errata --markdown > docs/errata.md
	@$(LIZARD) draw --robot robots/paper.toml --output docs/lizard.svg
	@$(LIZARD) parts out/parts --robot robots/paper.toml
	@cp out/parts/guide/robot.svg docs/robot.svg
	@$(LIZARD) draw --wiring --robot robots/paper.toml --output docs/wiring.svg
	@$(LIZARD) draw --horns --robot robots/paper.toml --output docs/horns.svg
	@$(LIZARD) draw charts docs/charts
	@cd crates && BLESS_KEYS=1 cargo test -p lizard-robot --lib --quiet keys::
	@cd crates && BLESS_PHYSICS=1 cargo test -p lizard-physics --test grains --test servos --test stored_results --quiet
	@BLESS_GAITS=1 $(MAKE) .docs-check
	@scripts/walk-through $(LIZARD)
	@scripts/setup-book
	@mkdocs build --strict --quiet
	@echo "the book: out/book/index.html"

# Runs tests that `make test` omits; BLESS_GAITS=1 writes the pages.
.docs-check:
	@cd crates && $(CARGO) test $(ALL) --quiet --test robot -- docs:: --ignored

# Also packages uncommitted changes, so that they can be tested before a commit.
.package:
	@rm -f crates/target/package/*.crate
# Cargo unpacks and compiles a dependency only once per path and version, so an older version of its source would
# remain.
	@rm -rf "$${CARGO_HOME:-$$HOME/.cargo}"/registry/src/-*/lizard-*
	@for list in $$(grep -ls 'registry/src/-' crates/target/*/debug/deps/lizard_*.d); do rm "$${list%/*}"/*"$$(basename "$$list" .d)"*; done
	@cd crates && cargo package --allow-dirty --quiet -p simulated-uno -p servo-pulses -p lizard-kinematics -p lizard-avr -p lizard-core
	@scripts/try-packages
	@cd crates && for package in target/package/*.crate; do echo "$$package"; done

# The code is the same for every robot; see firmware/README.md.
.code-image: .firmware
	@scripts/code-image

PREFIX ?= $(HOME)/.local
.install: .cli
	@scripts/install '$(PREFIX)'

.release:
	@scripts/release

.release-test:
	@scripts/release-test

.parallel-test:
	@cd crates && cargo build $(ALL) --bin lizard --quiet
	@scripts/parallel-test $(HOST)/debug/lizard

# Debian has the Arduino core but not the Servo library, so the comparison with this library runs only with SERVO.
.arduino-test: .sweep
	@scripts/arduino $(SERVO)
	@cd crates && cargo test $(ALL) --features lizard-host-tests/arduino --test arduino --quiet $(if $(SERVO),-- --include-ignored --nocapture)

# The package drives the board of the program's simulator over a serial port.
.python-test:
	@scripts/setup-python
	@cd crates && cargo build $(ALL) --bin lizard --quiet
	@scripts/python-test $(HOST)/debug/lizard

.addresses-test:
	@scripts/setup-web
	@scripts/setup-book
	@scripts/build-web
	@scripts/addresses-test

# Not part of .ci/run, because this target compiles everything three more times.
.desks:
	@scripts/setup-desks
	@cd crates && cargo build $(ALL) --bin lizard --quiet
	@scripts/desks $(HOST)/debug/lizard

.lint:
	@cargo fmt --check
	@cd crates && cargo fmt --all --check
	@RUSTC_BOOTSTRAP=1 cargo clippy --release -- -D warnings
	@cd crates && cargo clippy $(ALL) --all-targets --features lizard-host-tests/flash,lizard-host-tests/arduino --quiet -- -D warnings
	@cd crates && for features in paper,console simulator parts; do cargo clippy -p lizard-host --no-default-features --features $$features --quiet -- -D warnings || exit 1; done
	@cd crates && cargo clippy -p lizard-python --quiet -- -D warnings
	@cd crates && cargo clippy -p lizard-web --no-default-features --quiet -- -D warnings
	@cd crates && RUSTDOCFLAGS="-D warnings" cargo doc $(ALL) --no-deps --quiet
	@echo "lint: clean"
