/* Lists that grow. The reader looks at items and count, and may set count to 0.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

struct list {
	void *items;
	size_t count, room, size; /* items in use, items allocated, bytes of one */
};

/* Address of a new last item, not initialised. Ends the program when memory
 * does. */
void *list_push(struct list *list);
void list_free(struct list *list);

/* The bytes of one direction of the serial line, each with the cycle at which it was complete. */
struct serial_byte { uint64_t cycle; uint8_t byte; };

struct serial_bytes {
	struct list bytes;  /* struct serial_byte */
	bool line_ended;    /* a line feed has come; its reader sets it back */
};

void serial_bytes_init(struct serial_bytes *bytes);
void serial_bytes_push(struct serial_bytes *bytes, uint64_t cycle, uint8_t byte);
void serial_bytes_free(struct serial_bytes *bytes);
