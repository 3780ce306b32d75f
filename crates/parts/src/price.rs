//! Price classes of the things to buy. Shops differ by a factor of three for the same item, so a single figure
//! would suggest too much precision.

use std::fmt;

use serde::{Serialize, Serializer};

/// The month in which the classes were estimated.
pub const ESTIMATE_MONTH: &str = "November 2026";

/// The price class of a row of the bill: of all its pieces, or of the smallest pack sold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Price {
    /// Up to 1 euro.
    A,
    /// 1 to 3 euros.
    B,
    /// 3 to 7 euros.
    C,
    /// 7 to 15 euros.
    D,
    /// 15 to 30 euros.
    E,
}

impl Price {
    /// All classes, the cheapest first.
    pub const ALL: [Self; 5] = [Self::A, Self::B, Self::C, Self::D, Self::E];

    /// The least and the greatest price, euros.
    pub fn euros(self) -> [u32; 2] {
        match self {
            Self::A => [0, 1],
            Self::B => [1, 3],
            Self::C => [3, 7],
            Self::D => [7, 15],
            Self::E => [15, 30],
        }
    }

    /// The text that explains the classes.
    pub fn explanation() -> String {
        let class_texts = Self::ALL.map(|class| {
            let [from, to] = class.euros();
            match from {
                0 => format!("{class} up to {to}"),
                _ => format!("{class} {from} to {to}"),
            }
        });
        format!(
            "Price classes, euros for the whole row or the smallest pack: {}. They are estimates of {ESTIMATE_MONTH} for \
             European mail-order shops, without postage. Prices vary from shop to shop and from month to month.",
            class_texts.join(", ")
        )
    }

    /// The sum of some classes, euros: the least and the greatest total.
    pub fn sum(classes: impl Iterator<Item = Self>) -> [u32; 2] {
        classes.fold([0, 0], |sum, class| {
            let [from, to] = class.euros();
            [sum[0] + from, sum[1] + to]
        })
    }
}

impl fmt::Display for Price {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}

impl Serialize for Price {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
