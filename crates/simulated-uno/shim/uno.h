/* The interface of one simulated UNO to src/ffi.rs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "handlers.h"
#include "list.h"

struct uno;

/* The reason for the end of a run. Kept in step with `Stop` in src/ffi.rs. */
enum stop { STOP_TIME, STOP_LINE, STOP_HALTED, STOP_CRASHED, STOP_OFF };

void uno_set_logger(void);
/* `pins`: the pins whose edges are recorded, bit n = Arduino pin n. */
struct uno *uno_new(bool data_sheet, uint32_t pins, double baud);
void uno_free(struct uno *uno);
/* Puts `size` bytes into flash. False if they do not fit. */
bool uno_load(struct uno *uno, const uint8_t *code, uint32_t size, uint32_t address);
/* Ends loading: `code_end` bytes of flash are code, static data ends at
 * `data_end`. */
void uno_power_on(struct uno *uno, uint32_t code_end, uint16_t data_end);
/* Runs until cycle `until`, or the end of the firmware's next line. */
enum stop uno_run(struct uno *uno, uint64_t until);
void uno_stop_at_line(struct uno *uno, bool on);
/* Times the calls of the function at byte address `entry` from now on. */
void uno_time_calls(struct uno *uno, bool on, uint32_t entry);
/* `stop_low`: with the line low where each stop bit should be. */
void uno_send(struct uno *uno, const uint8_t *bytes, size_t length, bool stop_low);
void uno_flood(struct uno *uno, const uint8_t *bytes, size_t length);
void uno_set_baud(struct uno *uno, double baud);
uint32_t uno_cycles_per_bit(const struct uno *uno);
uint8_t uno_sampled(uint8_t byte, double ratio);
/* A foreign interrupt of so many cycles, now or when interrupts are on next. */
void uno_hold(struct uno *uno, uint64_t cycles);
/* Main executes nothing before cycle `until`; interrupts are served. */
void uno_stall_main(struct uno *uno, uint64_t until);
/* Writes a data address as `sts` would. */
void uno_poke(struct uno *uno, uint16_t address, uint8_t value);
size_t uno_unsent(const struct uno *uno);
uint64_t uno_sent(const struct uno *uno);
uint64_t uno_now(const struct uno *uno);
/* Cycles asleep up to now, the unfinished sleep included. */
uint64_t uno_asleep(const struct uno *uno);
uint32_t uno_pc(const struct uno *uno);
uint64_t uno_resets(const struct uno *uno);
uint64_t uno_overruns(const struct uno *uno);
uint32_t uno_levels(const struct uno *uno);
/* Lowest SRAM address that the stack has ever touched. */
uint16_t uno_stack_low(const struct uno *uno);
const char *uno_message(const struct uno *uno);
const uint8_t *uno_data(const struct uno *uno);
uint32_t uno_data_size(const struct uno *uno);
const struct vector_use *uno_vectors(const struct uno *uno);
struct list *uno_edges(struct uno *uno);             /* struct edge */
struct list *uno_marks(struct uno *uno);             /* struct mark */
struct list *uno_transmitted(struct uno *uno);       /* struct serial_byte */
struct list *uno_received(struct uno *uno);          /* struct serial_byte */
struct list *uno_calls(struct uno *uno);             /* struct call */

/* EEPROM, supply, ADC, contacts and resets: chip_access.c. */
void uno_reset(struct uno *uno); /* the RESET pin */
void uno_power_cycle(struct uno *uno);
void uno_set_boot_loader(struct uno *uno, bool on);
void uno_set_noise(struct uno *uno, uint64_t seed);
bool uno_held_in_reset(const struct uno *uno);
struct list *uno_reset_events(struct uno *uno);      /* struct reset_event */
uint8_t *uno_eeprom(struct uno *uno);                /* 1024 bytes */
struct list *uno_eeprom_operations(struct uno *uno); /* struct eeprom_operation */
/* The bits of a torn byte that are one though they should not be yet, or still
 * are though they should no longer. */
void uno_set_torn_ones(struct uno *uno, uint8_t ones);
void uno_cut_power_at(struct uno *uno, uint64_t cycle);
/* In the first EEPROM operation to come after `skip` others. */
void uno_cut_power_in_operation(struct uno *uno, uint64_t skip, bool in_write);
/* Takes back a cut that has not happened. */
void uno_keep_power(struct uno *uno);
double uno_supply(const struct uno *uno);
void uno_ramp_supply(struct uno *uno, double mv, uint64_t cycles);
void uno_set_brown_out(struct uno *uno, double mv);
void uno_set_bandgap(struct uno *uno, double mv);
void uno_set_analog(struct uno *uno, uint8_t channel, uint16_t mv);
/* A contact between ground and the pin of this bit of the port whose PIN register this is. */
void uno_set_contact(struct uno *uno, uint16_t address, uint8_t bit, bool closed);

/* Boot loader and flash: boot.c. */
/* From now on a reset starts the program at this byte address (BOOTRST). */
void uno_boot_at(struct uno *uno, uint32_t address);
uint8_t *uno_flash(struct uno *uno);                 /* 32768 bytes */
