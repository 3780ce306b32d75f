# Every target sets up what it needs (scripts/setup) and is quick the second time.
MAKEFLAGS += --no-print-directory
ELF := target/avr-atmega328p/release/lizard.elf
LIZARD := host/target/release/lizard
-include target/toolchain.mk

# Set-up decides which compiler is used, so it runs before anything else and
# hands over to a make that has read its answer.
define prepared
	@scripts/setup
	@$(MAKE) $(1)
endef

.PHONY: help sim test firmware flash lint cli bench docs clean .firmware .gaits .flash .lint .cli .sim .test .bench .docs

help: ## this list
	@grep -E '^[a-z]+:.*## ' Makefile | sed -E 's/^([a-z]+):.*## /\1\t/' | expand -t 12

sim: ## the firmware walks on a simulated UNO; a table and a picture of its gait
	$(call prepared,.sim)
test: ## every test, on the host and on the simulated UNO
	$(call prepared,.test)
firmware: ## build the firmware for the UNO, .elf and .hex; print flash, RAM and every gait's margins
	$(call prepared,.gaits)
flash: ## build, write to a UNO on USB, open its console (ravedude)
	$(call prepared,.flash)
lint: ## rustfmt and clippy, warnings are errors
	$(call prepared,.lint)
cli: ## build the host program, host/target/release/lizard
	$(call prepared,.cli)
bench: ## measured budgets, beside the Arduino Servo library's; speed beside numpy's
	$(call prepared,.bench)
docs: ## write anew the pages and pictures that programs make
	$(call prepared,.docs)
clean: ## remove everything that was built
	rm -rf target host/target out

# RUSTC_BOOTSTRAP opens the AVR parts of a stable compiler, for this build alone.
.firmware:
	@RUSTC_BOOTSTRAP=1 cargo build --release
	@avr-objcopy -O ihex -R .eeprom $(ELF) $(ELF:.elf=.hex)
	@scripts/size $(ELF)

.gaits: .firmware
	@echo
	@cat $(dir $(ELF))gaits.txt

.flash: .firmware
	@scripts/setup-flash
	@RUSTC_BOOTSTRAP=1 cargo run --release

# cargo puts what it builds for the host under the host's name; this is where
# the documentation says the program is.
.cli:
	@cd host && cargo build --release
	@cd host && ln -f target/$$(rustc --print host-tuple)/release/lizard target/release/lizard 2>/dev/null || \
		{ mkdir -p target/release && ln -f target/$$(rustc --print host-tuple)/release/lizard target/release/lizard; }

.sim: .firmware .cli
	@$(LIZARD) sim --elf $(ELF)

# The same random inputs every time; PROPTEST_RNG_SEED=2 make test takes others.
.test: .firmware
	@cd host && PROPTEST_RNG_SEED=$${PROPTEST_RNG_SEED:-1} cargo test --workspace --quiet

.bench: .firmware .cli
	@scripts/setup-bench
	@$(LIZARD) bench
	@echo
	@$(LIZARD) speed

.docs: .firmware .cli
	@$(LIZARD) errata --markdown > docs/errata.md
	@$(LIZARD) draw --output docs/lizard.svg
	@$(LIZARD) charts docs/charts --svg-only
	@scripts/walk-through $(LIZARD)

.lint:
	@cargo fmt --check
	@cd host && cargo fmt --all --check
	@RUSTC_BOOTSTRAP=1 cargo clippy --release -- -D warnings
	@cd host && cargo clippy --workspace --all-targets --quiet -- -D warnings
	@echo "lint: clean"
