//! Price classes of the items to buy. Shops differ by a factor of three for the same item, so a single value would
//! suggest too much precision.

use std::fmt;

use serde::Serialize;

/// The price class of a row of the bill of materials: of all its pieces, or of the smallest pack sold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum PriceClass {
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

impl PriceClass {
    /// All classes, the cheapest first.
    pub const ALL: [Self; 5] = [Self::A, Self::B, Self::C, Self::D, Self::E];

    /// Lowest and highest price, euros.
    pub fn euro_range(self) -> [u32; 2] {
        match self {
            Self::A => [0, 1],
            Self::B => [1, 3],
            Self::C => [3, 7],
            Self::D => [7, 15],
            Self::E => [15, 30],
        }
    }

    /// Explains the classes.
    pub fn explanation() -> String {
        let class_texts = Self::ALL.map(|class| {
            let [min, max] = class.euro_range();
            match min {
                0 => format!("{class} up to {max}"),
                _ => format!("{class} {min} to {max}"),
            }
        });
        format!(
            "Price classes, euros for the whole row or the smallest pack: {}. They are estimates of November 2026 for \
             European mail-order shops, without postage. Prices vary from shop to shop and from month to month.",
            class_texts.join(", ")
        )
    }

    /// Adds up classes to the lowest and the highest total, euros.
    pub fn sum(classes: impl Iterator<Item = Self>) -> [u32; 2] {
        classes.fold([0, 0], |sum, class| {
            let [min, max] = class.euro_range();
            [sum[0] + min, sum[1] + max]
        })
    }
}

impl fmt::Display for PriceClass {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}
