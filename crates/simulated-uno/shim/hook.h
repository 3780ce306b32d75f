/* A place of its own in simavr's table of I/O registers: what is called when
 * the firmware reads or writes one. simavr's own registration refuses to
 * replace a callback that is there.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef HOOK_H
#define HOOK_H

#include <stdint.h>

#include <simavr/sim_avr.h>

struct write_hook { avr_io_write_t call; void *param; };
struct read_hook { avr_io_read_t call; void *param; };

/* Both return what was called before. `address` is a data address. */
struct write_hook hook_write(avr_t *avr, uint16_t address, avr_io_write_t call, void *param);
struct read_hook hook_read(avr_t *avr, uint16_t address, avr_io_read_t call, void *param);

#endif
