//! The result of an identification.

use crate::card::Card;
use crate::key::Key;
use crate::way::Way;

/// The result for all keys.
#[derive(Clone, Debug)]
pub struct Identified {
    /// The keys in the order of [`crate::KEYS`].
    pub keys: Vec<Found>,
    /// The card, and the standard errors of its parts.
    pub card: [Card; 2],
    /// Pairs of keys whose errors are correlated by more than 0.8, with the correlation.
    pub alike: Vec<(&'static Key, &'static Key, f64)>,
    /// How well the model explains the ways.
    pub goodness: Goodness,
    /// The measured ways beside the model's.
    pub rows: Vec<Row>,
}

/// The result for a key.
#[derive(Clone, Debug)]
pub struct Found {
    /// The key.
    pub key: &'static Key,
    /// Value in the file.
    pub before: f64,
    /// Value with which the ways agree best; that of the file unless the key is moved.
    pub after: f64,
    /// Standard error of the value that the ways give it.
    pub error: f64,
    /// The decision.
    pub verdict: Verdict,
}

/// A decision about a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The ways contradict the file by more than two standard errors.
    Moved,
    /// The file's value agrees with the ways.
    Right,
    /// The ways leave more than half of its doubt.
    Untold,
    /// The ways ask for this value, which is below the least possible one.
    Impossible(f64),
}

/// How well the model explains the ways.
#[derive(Clone, Copy, Debug)]
pub struct Goodness {
    /// Measured figures.
    pub figures: usize,
    /// Sum of squares of the differences in standard errors: with the file's values, with the new ones, and with all keys moved.
    pub chi_square: [f64; 3],
    /// Figures less what the fit of all keys used up of them.
    pub freedom: f64,
    /// The sum of squares that 1 % of true models exceed; 0 without a degree of freedom.
    pub limit: f64,
    /// False if less than 1 % of true models differ as much from the ways.
    pub explains: bool,
    /// Factor by which all errors were widened.
    pub widened: f64,
    /// The row and the part that differ most from the ways with the new values, in standard errors.
    pub worst: (usize, usize, f64),
}

/// A measured way beside the model's.
#[derive(Clone, Debug)]
pub struct Row {
    /// The measured way. A part that two feet against two decide has an infinite error, and counts for nothing.
    pub way: Way,
    /// The way by the file.
    pub before: [f64; 3],
    /// The way with the new values.
    pub after: [f64; 3],
}

impl Identified {
    /// The keys that are moved.
    pub fn moved(&self) -> impl Iterator<Item = &Found> {
        let keys = self.keys.iter();
        keys.filter(|found| found.verdict == Verdict::Moved)
    }
}

impl Found {
    /// Digits behind the point of the value: so many that the error has two.
    pub fn digits(&self) -> usize {
        let first = -self.error.log10().floor();
        (first + 1.0).clamp(0.0, 6.0) as usize
    }
}
