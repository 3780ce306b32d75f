//! Search for an order of functions that places functions near their callers.
//!
//! A `call` has two words. If the target is less than 4 KB away, the linker replaces the `call` with an `rcall` of one
//! word, and a `jmp` with an `rjmp` (`--relax`). A compiler does not consider these distances. Nearly all functions
//! call the routines of `frames.S`, and in the compiler's order most functions would be far from these routines. This
//! module therefore searches for the order in which the fewest calls are out of reach; each near call also saves a
//! cycle. The order cannot change a program's behaviour: every reference from one function to another is a relocation,
//! and no function falls through into the next.

/// The reach of a relative call minus the error of the estimated sizes, bytes.
const REACH_BYTES: u32 = 4096 - 96;

/// The cost of a call out of reach. Each byte beyond the reach adds 1, so that the search detects an improvement before
/// the call is within reach.
const OUT_OF_REACH_COST: u32 = 16_384;

/// The number of orders tried.
const ATTEMPT_COUNT: u32 = 600_000;

/// The cost increase that is accepted at first. The accepted increase falls to 0 during the search.
const INITIAL_RISE: u32 = 4 * OUT_OF_REACH_COST;

/// The seed of the search; any other number would work as well.
const SEED: u64 = 1;

/// A call or a jump from one piece of code to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Call {
    /// The piece that contains the call.
    pub caller: usize,
    /// The offset in the calling piece, bytes.
    pub offset: u32,
    /// The piece that is called.
    pub callee: usize,
}

/// Pieces of code that may be put into any order, except for the last piece, which stays last.
#[derive(Debug, Clone, Default)]
pub struct Pieces {
    /// The size of each piece, bytes.
    pub sizes: Vec<u32>,
    /// The calls and jumps from one piece to another.
    pub calls: Vec<Call>,
}

impl Pieces {
    /// Searches for the order in which the fewest calls are out of reach. Moves random pieces, and undoes a move that
    /// increases the cost by more than a threshold, which falls to zero (threshold accepting, Dueck and Scheuer 1990).
    /// Computes in integers, so that the result is the same on every machine. The last piece stays last.
    pub fn find_order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.sizes.len()).collect();
        let movable_count = self.sizes.len().saturating_sub(1);
        let mut rng = fastrand::Rng::with_seed(SEED);
        let mut current_cost = self.compute_cost(&order);
        let (mut best_order, mut best_cost) = (order.clone(), current_cost);
        for attempts_left in (0..ATTEMPT_COUNT).rev() {
            if best_cost == 0 || movable_count < 2 {
                break;
            }
            let accepted_rise =
                u64::from(INITIAL_RISE) * u64::from(attempts_left) / u64::from(ATTEMPT_COUNT);
            let [from, to] = [0; 2].map(|_| rng.usize(..movable_count));
            move_piece(&mut order, from, to);
            let cost = self.compute_cost(&order);
            if cost > current_cost + accepted_rise {
                move_piece(&mut order, to, from);
                continue;
            }
            current_cost = cost;
            if current_cost < best_cost {
                (best_order, best_cost) = (order.clone(), current_cost);
            }
        }
        best_order
    }

    /// Returns the number of calls out of reach in an order.
    pub fn count_out_of_reach(&self, order: &[usize]) -> usize {
        self.bytes_beyond_reach(order).count()
    }

    /// Returns the cost of an order.
    fn compute_cost(&self, order: &[usize]) -> u64 {
        let distances = self.bytes_beyond_reach(order);
        let costs = distances.map(|bytes| u64::from(OUT_OF_REACH_COST + bytes));
        costs.sum()
    }

    /// Returns the number of bytes by which each call is out of reach. Leaves out the calls within reach.
    fn bytes_beyond_reach(&self, order: &[usize]) -> impl Iterator<Item = u32> {
        let mut offsets = vec![0; self.sizes.len()];
        let mut offset = 0;
        for piece in order {
            offsets[*piece] = offset;
            offset += self.sizes[*piece];
        }
        let distances = self.calls.iter().map(move |call| {
            let distance = (offsets[call.caller] + call.offset).abs_diff(offsets[call.callee]);
            distance.saturating_sub(REACH_BYTES)
        });
        distances.filter(|bytes| *bytes > 0)
    }
}

/// Moves a piece from one index to another.
fn move_piece(order: &mut [usize], from: usize, to: usize) {
    if from < to {
        order[from..=to].rotate_left(1);
    } else {
        order[to..=from].rotate_right(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn call(caller: usize, offset: u32, callee: usize) -> Call {
        Call {
            caller,
            offset,
            callee,
        }
    }

    /// Returns 21 pieces. Each of the first ten calls the piece ten places later, and the first piece also calls the
    /// last.
    fn build_pairs() -> Pieces {
        let mut sizes = vec![700; 20];
        sizes.push(0);
        let mut calls: Vec<Call> = (0..10)
            .map(|caller| call(caller, 100, caller + 10))
            .collect();
        calls.push(call(0, 200, 20));
        Pieces { sizes, calls }
    }

    #[test]
    fn pieces_are_placed_near_their_callers_if_possible() {
        let pieces = build_pairs();
        let compiled_order: Vec<usize> = (0..21).collect();
        assert_eq!(pieces.count_out_of_reach(&compiled_order), 11);
        assert_eq!(pieces.count_out_of_reach(&pieces.find_order()), 0);
    }

    #[test]
    fn every_run_finds_the_same_order_which_contains_all_pieces_and_ends_with_the_last() {
        let order = build_pairs().find_order();
        assert_eq!(order, build_pairs().find_order());
        assert_eq!(order.last(), Some(&20));
        let mut sorted_order = order;
        sorted_order.sort_unstable();
        assert_eq!(sorted_order, (0..21).collect::<Vec<_>>());
    }

    #[test]
    fn an_empty_list_and_a_single_movable_piece_have_an_order() {
        assert!(Pieces::default().find_order().is_empty());
        let pieces = Pieces {
            sizes: vec![9000, 0],
            calls: vec![call(0, 0, 1)],
        };
        assert_eq!(pieces.find_order(), [0, 1]);
        assert_eq!(pieces.count_out_of_reach(&[0, 1]), 1);
    }
}
