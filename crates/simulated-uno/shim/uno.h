/* The interface of one simulated UNO to src/ffi.rs, which also calls usart_sample_byte.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "handlers.h"
#include "list.h"

struct uno;

/* The reason for the end of a run. Must match `StopReason` in src/ffi.rs. */
enum stop_reason {
	STOP_CYCLE_REACHED, /* the requested cycle was reached */
	STOP_LINE_SENT,     /* the firmware has sent a line feed */
	STOP_HALTED,        /* the CPU sleeps, and nothing can wake it */
	STOP_CRASHED,       /* invalid instruction or address; see uno_error_message */
	STOP_POWER_CUT,     /* the power was cut */
};

/* Directs simavr's error messages to the uno that they concern. Call this function once. */
void uno_set_logger(void);
/* `follows_data_sheet`: true for the data-sheet fidelity (simavr corrected to match the data
 * sheet), false for the stock fidelity (simavr without corrections). `baud`: the sender's baud
 * rate. */
struct uno *uno_new(bool follows_data_sheet, double baud);
void uno_free(struct uno *uno);
/* The code in flash ends before byte address `code_end`, and the static data before data address
 * `data_end`. */
void uno_set_program_bounds(struct uno *uno, uint32_t code_end, uint16_t data_end);
/* Runs until cycle `until`, or until another stop reason occurs. With `stops_at_line`, the run ends as
 * soon as the firmware has sent a complete line. */
enum stop_reason uno_run(struct uno *uno, uint64_t until, bool stops_at_line);
/* Starts or stops timing the calls of the function at this byte address. */
void uno_time_calls(struct uno *uno, bool is_enabled, uint32_t entry_address);
/* Queues bytes for the serial line. `is_stop_bit_low`: the line is low during each stop bit. */
void uno_send(struct uno *uno, const uint8_t *bytes, size_t length, bool is_stop_bit_low);
/* Sends `bytes` repeatedly whenever the queue is empty; length 0 ends the flood. */
void uno_set_flood(struct uno *uno, const uint8_t *bytes, size_t length);
/* Sets the sender's baud rate. */
void uno_set_baud(struct uno *uno, double baud);
/* The length of a bit of the chip's USART, cycles, as its registers set it. */
uint32_t uno_cycles_per_bit(const struct uno *uno);
/* Occupies the CPU for `cycles`, as a foreign interrupt would, at once or as soon as interrupts are
 * enabled; see disturbance.h. */
void uno_block_cpu(struct uno *uno, uint64_t cycles);
/* The main program executes nothing before cycle `until`; interrupts are served. */
void uno_stall_main(struct uno *uno, uint64_t until);
/* Writes to a data address as the instruction `sts` would. */
void uno_poke(struct uno *uno, uint16_t address, uint8_t value);
/* The number of queued bytes that have not yet arrived at the uno. */
size_t uno_unsent_count(const struct uno *uno);
/* The number of bytes sent to the uno so far, including floods. */
uint64_t uno_sent_count(const struct uno *uno);
/* The current cycle. */
uint64_t uno_now(const struct uno *uno);
/* The cycles in which the CPU has slept so far, including an unfinished sleep. */
uint64_t uno_sleep_cycles(const struct uno *uno);
/* The byte address in flash of the next instruction. */
uint32_t uno_pc(const struct uno *uno);
/* The number of resets by the watchdog. */
uint64_t uno_watchdog_reset_count(const struct uno *uno);
/* The number of bytes that the chip's USART has lost. */
uint64_t uno_overrun_count(const struct uno *uno);
/* The recorded pins that are high, bit n = Arduino pin n. */
uint32_t uno_pin_levels(const struct uno *uno);
/* The lowest SRAM address that the stack has reached since power-on. */
uint16_t uno_lowest_stack_address(const struct uno *uno);
/* The last error that simavr logged; empty if none. */
const char *uno_error_message(const struct uno *uno);
/* The data space: registers r0 to r31, I/O registers and SRAM; CHIP_SRAM_END bytes. */
const uint8_t *uno_data(const struct uno *uno);
/* CHIP_VECTOR_COUNT items, indexed by the vector number. */
const struct vector_stats *uno_vectors(const struct uno *uno);
struct list *uno_edges(struct uno *uno);             /* struct edge */
struct list *uno_marks(struct uno *uno);             /* struct mark */
struct list *uno_transmitted(struct uno *uno);       /* struct serial_byte */
struct list *uno_received(struct uno *uno);          /* struct serial_byte */
struct list *uno_calls(struct uno *uno);             /* struct call */

/* The functions below are in chip_access.c. */

/* Pulls the RESET pin low for an instant. */
void uno_reset(struct uno *uno);
/* Cuts the power and restores it at once. */
void uno_power_cycle(struct uno *uno);
/* Simulates the effects of a boot loader: MCUSR is zero when the firmware starts. */
void uno_set_boot_loader(struct uno *uno, bool is_present);
/* Chooses the noise that the next power-on leaves in the SRAM. */
void uno_set_noise_seed(struct uno *uno, uint64_t seed);
/* True while the supply is too low for the chip to run. */
bool uno_is_held_in_reset(const struct uno *uno);
struct list *uno_reset_events(struct uno *uno);      /* struct reset_event */
uint8_t *uno_eeprom(struct uno *uno);                /* 1024 bytes */
struct list *uno_eeprom_operations(struct uno *uno); /* struct eeprom_operation */
/* Sets the bits that read as 1 in a torn byte, in addition to the ones of its old value (if the
 * power is cut during the erase phase) or of its new value (during the write phase). */
void uno_set_torn_bits(struct uno *uno, uint8_t ones);
/* Cuts the power at this cycle. */
void uno_cut_power_at(struct uno *uno, uint64_t cycle);
/* Cuts the power in an EEPROM operation, after `skip_count` skipped operations. `in_write`: true for
 * the write phase, false for the erase phase. */
void uno_cut_power_in_operation(struct uno *uno, uint64_t skip_count, bool in_write);
/* Cancels every power cut that has not happened yet. */
void uno_cancel_power_cut(struct uno *uno);
/* The current supply voltage, mV. */
double uno_supply_mv(const struct uno *uno);
/* Changes the supply voltage linearly to `mv` over `cycles`. */
void uno_ramp_supply(struct uno *uno, double mv, uint64_t cycles);
/* Sets the brown-out level, mV; 0 disables brown-out detection. */
void uno_set_brown_out(struct uno *uno, double mv);
/* Sets the voltage of the bandgap reference, mV. */
void uno_set_bandgap(struct uno *uno, double mv);
/* Sets the voltage at the analogue pin of this ADC channel, mV. */
void uno_set_analog(struct uno *uno, uint8_t channel, uint16_t mv);
/* Closes or opens a contact between ground and the pin with this Arduino number. */
void uno_set_contact(struct uno *uno, uint8_t number, bool is_closed);

/* Makes the program start at this byte address in flash, now and after every reset, as the fuse
 * BOOTRST does. */
void uno_set_boot_address(struct uno *uno, uint32_t address);
uint8_t *uno_flash(struct uno *uno);                 /* 32768 bytes */
