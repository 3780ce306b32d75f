//! Functions that call one another lie near one another.
//!
//! A `call` has two words. If the target is less than 4 KB away, the linker turns it into
//! an `rcall` of one word, and a `jmp` into an `rjmp` (`--relax`). A compiler writes
//! functions in the order in which it meets them, and the routines of `frames.S`, which
//! nearly all functions call, came last. So this module searches the order in which the
//! fewest calls are out of reach; each of them also saves a cycle. The order cannot
//! change what a program does: every reference from one function to another is a
//! relocation, and no function runs on into the next.

/// How far a relative call reaches, bytes, less what the estimate of the sizes may be wrong by.
const REACH: u32 = 4096 - 96;

/// What a call out of reach costs, where a byte of the way that it is too long costs 1: the
/// way tells only in which direction things get better.
const FAR: u32 = 16_384;

/// How many orders are tried, and by how much one may be worse than the one before at
/// first; in the end not at all.
const TRIES: u32 = 600_000;
const WORSE: u32 = 4 * FAR;

/// Any number does.
const SEED: u64 = 1;

/// A call or a jump from one piece of code to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Call {
    /// The piece that it is in.
    pub from: usize,
    /// Bytes from that piece's beginning.
    pub at: u32,
    /// The piece that it leads to.
    pub to: usize,
}

/// Pieces of code, all of which but the last may be put into any order.
#[derive(Debug, Clone, Default)]
pub struct Pieces {
    /// Bytes of each.
    pub sizes: Vec<u32>,
    /// What leads from one to another.
    pub calls: Vec<Call>,
}

impl Pieces {
    /// The order in which the fewest calls are out of reach, as far as a search finds it: pieces
    /// are put elsewhere at random, and what makes things much worse is undone, less and less
    /// being much (threshold accepting, Dueck and Scheuer 1990). In whole numbers, so that it
    /// is the same on every machine. The last piece stays the last.
    pub fn order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.sizes.len()).collect();
        let movable = self.sizes.len().saturating_sub(1);
        let mut random = fastrand::Rng::with_seed(SEED);
        let mut now = self.cost(&order);
        let (mut best, mut least) = (order.clone(), now);
        for left in (0..TRIES).rev() {
            if least == 0 || movable < 2 {
                break;
            }
            let worse = u64::from(WORSE) * u64::from(left) / u64::from(TRIES);
            let [from, to] = [0; 2].map(|_| random.usize(..movable));
            turn(&mut order, from, to);
            let cost = self.cost(&order);
            if cost > now + worse {
                turn(&mut order, to, from);
                continue;
            }
            now = cost;
            if now < least {
                (best, least) = (order.clone(), now);
            }
        }
        best
    }

    /// How many calls are out of reach in an order.
    pub fn far(&self, order: &[usize]) -> usize {
        self.beyond(order).filter(|beyond| *beyond > 0).count()
    }

    /// What an order costs.
    fn cost(&self, order: &[usize]) -> u64 {
        let far = self.beyond(order).filter(|beyond| *beyond > 0);
        far.map(|beyond| u64::from(FAR + beyond)).sum()
    }

    /// By how many bytes each call is out of reach.
    fn beyond(&self, order: &[usize]) -> impl Iterator<Item = u32> {
        let mut places = vec![0; self.sizes.len()];
        let mut place = 0;
        for piece in order {
            places[*piece] = place;
            place += self.sizes[*piece];
        }
        self.calls.iter().map(move |call| {
            let distance = (places[call.from] + call.at).abs_diff(places[call.to]);
            distance.saturating_sub(REACH)
        })
    }
}

/// Takes what is at one place to another.
fn turn(order: &mut [usize], from: usize, to: usize) {
    if from < to {
        order[from..=to].rotate_left(1);
    } else {
        order[to..=from].rotate_right(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten pairs that call each other and lie ten pieces apart, and one at the end that the
    /// first calls.
    fn pairs() -> Pieces {
        let mut pieces = Pieces {
            sizes: vec![700; 20],
            calls: Vec::new(),
        };
        pieces.sizes.push(0);
        for from in 0..10 {
            let to = from + 10;
            pieces.calls.push(Call { from, at: 100, to });
        }
        let call = Call {
            from: 0,
            at: 200,
            to: 20,
        };
        pieces.calls.push(call);
        pieces
    }

    #[test]
    fn all_that_can_be_near_one_another_are() {
        let pieces = pairs();
        let compiled: Vec<usize> = (0..21).collect();
        assert_eq!(pieces.far(&compiled), 11);
        assert_eq!(pieces.far(&pieces.order()), 0);
    }

    #[test]
    fn every_piece_has_one_place_the_last_the_last_and_always_the_same() {
        let order = pairs().order();
        assert_eq!(order, pairs().order());
        assert_eq!(order.last(), Some(&20));
        let mut all = order;
        all.sort_unstable();
        assert_eq!(all, (0..21).collect::<Vec<_>>());
    }

    #[test]
    fn nothing_and_little_have_an_order() {
        assert!(Pieces::default().order().is_empty());
        let one = Pieces {
            sizes: vec![9000, 0],
            calls: vec![Call {
                from: 0,
                at: 0,
                to: 1,
            }],
        };
        assert_eq!(one.order(), [0, 1]);
        assert_eq!(one.far(&[0, 1]), 1);
    }
}
