//! The generator of the polynomials' coefficients in `src/angle.rs`. A test compares the
//! coefficients there with the generated ones, and prints these if they differ.
//!
//! Each polynomial interpolates a smooth function of the square of an argument at Chebyshev
//! nodes, which keeps the largest error within a few per cent of the minimum for
//! a polynomial of its degree. The nodes, the functions and the solution
//! are computed with 256 bits; each coefficient is rounded once, to the nearest f64.

use dashu_float::{FBig, round::mode::HalfEven};

/// A number of 256 bits.
type Number = FBig<HalfEven, 2>;

/// Precision of every computation, bits.
const BITS: usize = 256;
/// Share by which the interval of nodes extends past the square of the largest argument,
/// since rounding may push an argument over its limit.
const MARGIN_SHARE: f64 = 1e-4;
/// Number of points at which an error is measured.
const POINTS: u32 = 2000;

/// The polynomial P in an approximation f(x) = lead(x) + x^power P(x^2).
pub struct Polynomial {
    /// The polynomial's name in `src/angle.rs`.
    pub name: &'static str,
    /// Number of coefficients.
    terms: u32,
    /// The largest argument: radians, or a tangent for `ATAN`.
    limit: fn() -> Number,
    /// The function f.
    function: fn(&Number) -> Number,
    /// The exact first terms of the function's power series.
    lead: fn(&Number) -> Number,
    /// The exponent of the argument in the factor of the polynomial.
    power: i32,
}

/// All three polynomials, in the order of `src/angle.rs`.
pub const POLYNOMIALS: [Polynomial; 3] = [
    Polynomial {
        name: "SIN",
        terms: 6,
        limit: || Number::pi(BITS) / number_of(4),
        function: Number::sin,
        lead: Number::clone,
        power: 3,
    },
    Polynomial {
        name: "COS",
        terms: 6,
        limit: || Number::pi(BITS) / number_of(4),
        function: Number::cos,
        lead: |r| number_of(1) - r * r / number_of(2),
        power: 4,
    },
    Polynomial {
        name: "ATAN",
        terms: 11,
        limit: || (Number::pi(BITS) / number_of(8)).tan(),
        function: Number::atan,
        lead: Number::clone,
        power: 3,
    },
];

fn number_of(value: u32) -> Number {
    Number::from(value).with_precision(BITS).value()
}

/// Converts an f64 exactly.
fn exact_number_of(value: f64) -> Number {
    let exact = Number::try_from(value).expect("a finite number");
    exact.with_precision(BITS).value()
}

impl Polynomial {
    /// Computes the coefficients, the constant first.
    pub fn coefficients(&self) -> Vec<f64> {
        let limit = (self.limit)();
        let largest_square = &limit * &limit * (number_of(1) + exact_number_of(MARGIN_SHARE));
        let half_interval = largest_square / number_of(2);
        let nodes: Vec<Number> = (0..self.terms)
            .map(|k| {
                let turn = Number::pi(BITS) * number_of(2 * k + 1) / number_of(2 * self.terms);
                &half_interval * (number_of(1) + turn.cos())
            })
            .collect();
        // Computes divided differences, then expands Newton's form to powers.
        let mut differences: Vec<Number> =
            nodes.iter().map(|z| self.target_value(&z.sqrt())).collect();
        for order in 1..nodes.len() {
            for i in (order..nodes.len()).rev() {
                let rise = &differences[i] - &differences[i - 1];
                differences[i] = rise / (&nodes[i] - &nodes[i - order]);
            }
        }
        let mut powers: Vec<Number> = Vec::new();
        for (node, difference) in nodes.iter().zip(&differences).rev() {
            // powers * (z - node) + difference
            let mut next_powers = vec![number_of(0); powers.len() + 1];
            for (i, power) in powers.iter().enumerate() {
                next_powers[i + 1] += power;
                next_powers[i] -= power * node;
            }
            next_powers[0] += difference;
            powers = next_powers;
        }
        powers.iter().map(|power| power.to_f64().value()).collect()
    }

    /// The largest error of the approximation with these coefficients, relative
    /// to the function, for arguments up to the limit.
    pub fn error(&self, coefficients: &[f64]) -> f64 {
        let limit = (self.limit)();
        (1..=POINTS)
            .map(|i| {
                let x = &limit * number_of(i) / number_of(POINTS);
                let z = &x * &x;
                let sum = coefficients
                    .iter()
                    .rev()
                    .fold(number_of(0), |sum, c| sum * &z + exact_number_of(*c));
                let deviation =
                    (sum - self.target_value(&x)) * power_of(&x, self.power) / (self.function)(&x);
                deviation.to_f64().value().abs()
            })
            .fold(0.0, f64::max)
    }

    /// The exact value, at an argument x, that the polynomial P approximates.
    fn target_value(&self, x: &Number) -> Number {
        ((self.function)(x) - (self.lead)(x)) / power_of(x, self.power)
    }
}

fn power_of(x: &Number, n: i32) -> Number {
    (1..n).fold(x.clone(), |power, _| power * x)
}
