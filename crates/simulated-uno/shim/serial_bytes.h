/* Bytes of one direction of the serial line, each with the cycle at which it
 * was complete.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef SERIAL_BYTES_H
#define SERIAL_BYTES_H

#include <stdbool.h>
#include <stdint.h>

#include "list.h"

struct serial_byte { uint64_t cycle; uint8_t byte; };

struct serial_bytes {
	struct list bytes;  /* struct serial_byte */
	bool line_ended;    /* a line feed has come; its reader sets it back */
};

void serial_bytes_init(struct serial_bytes *bytes);
void serial_bytes_push(struct serial_bytes *bytes, uint64_t cycle, uint8_t byte);
void serial_bytes_free(struct serial_bytes *bytes);

#endif
