/* A list that grows. The reader looks at items and count, and may set count
 * to 0.
 *
 * simulated-uno: an Arduino UNO on libsimavr, for tests.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef LIST_H
#define LIST_H

#include <stddef.h>

struct list {
	void *items;
	size_t count, room, size; /* items in use, items allocated, bytes of one */
};

/* Address of a new last item, not initialised. Ends the program when memory
 * does. */
void *list_push(struct list *list);
void list_free(struct list *list);

#endif
