//! The generator of the polynomials of `src/angle.rs`. A test compares their coefficients
//! with it, and prints the generator's if they differ.
//!
//! Each polynomial interpolates a smooth function of the square of an argument at Chebyshev
//! nodes, which keeps the largest error within a few per cent of the least that
//! any polynomial of its degree has. The nodes, the functions and the solution
//! carry 256 bits; each coefficient is rounded once, to the nearest f64.

use dashu_float::{FBig, round::mode::HalfEven};

/// A number of 256 bits.
type Number = FBig<HalfEven, 2>;

/// Precision of every computation, bits.
const BITS: usize = 256;
/// Share by which the interval of nodes is longer than the arguments need, for
/// arguments that rounding has pushed over its end.
const MARGIN_SHARE: f64 = 1e-4;
/// Points at which an error is measured.
const POINTS: u32 = 2000;

/// A polynomial that approximates part of a function.
pub struct Polynomial {
    /// The polynomial's name in `src/angle.rs`.
    pub name: &'static str,
    /// Number of coefficients.
    terms: u32,
    /// The largest argument, radians or a tangent.
    limit: fn() -> Number,
    /// The function that it approximates.
    function: fn(&Number) -> Number,
    /// The terms that are added to the polynomial's part.
    lead: fn(&Number) -> Number,
    /// The power of the argument that multiplies the polynomial.
    power: i32,
}

/// All three polynomials, in the order of `src/angle.rs`.
pub const POLYNOMIALS: [Polynomial; 3] = [
    Polynomial {
        name: "SIN",
        terms: 6,
        limit: || Number::pi(BITS) / number(4),
        function: Number::sin,
        lead: Number::clone,
        power: 3,
    },
    Polynomial {
        name: "COS",
        terms: 6,
        limit: || Number::pi(BITS) / number(4),
        function: Number::cos,
        lead: |r| number(1) - r * r / number(2),
        power: 4,
    },
    Polynomial {
        name: "ATAN",
        terms: 11,
        limit: || (Number::pi(BITS) / number(8)).tan(),
        function: Number::atan,
        lead: Number::clone,
        power: 3,
    },
];

fn number(whole: u32) -> Number {
    Number::from(whole).with_precision(BITS).value()
}

/// An f64 exactly.
fn exact_number(value: f64) -> Number {
    let exact = Number::try_from(value).expect("a finite number");
    exact.with_precision(BITS).value()
}

impl Polynomial {
    /// The coefficients, the constant first.
    pub fn coefficients(&self) -> Vec<f64> {
        let limit = (self.limit)();
        let longest = &limit * &limit * (number(1) + exact_number(MARGIN_SHARE));
        let half = longest / number(2);
        let nodes: Vec<Number> = (0..self.terms)
            .map(|k| {
                let turn = Number::pi(BITS) * number(2 * k + 1) / number(2 * self.terms);
                &half * (number(1) + turn.cos())
            })
            .collect();
        // Divided differences, then Newton's form multiplied out.
        let mut differences: Vec<Number> = nodes.iter().map(|z| self.target(&z.sqrt())).collect();
        for order in 1..nodes.len() {
            for i in (order..nodes.len()).rev() {
                let rise = &differences[i] - &differences[i - 1];
                differences[i] = rise / (&nodes[i] - &nodes[i - order]);
            }
        }
        let mut powers: Vec<Number> = Vec::new();
        for (node, difference) in nodes.iter().zip(&differences).rev() {
            // powers * (z - node) + difference
            let mut next = vec![number(0); powers.len() + 1];
            for (i, power) in powers.iter().enumerate() {
                next[i + 1] += power;
                next[i] -= power * node;
            }
            next[0] += difference;
            powers = next;
        }
        powers.iter().map(|power| power.to_f64().value()).collect()
    }

    /// The largest error that coefficients leave in the function within the
    /// limit, relative to the function.
    pub fn error(&self, coefficients: &[f64]) -> f64 {
        let limit = (self.limit)();
        (1..=POINTS)
            .map(|i| {
                let x = &limit * number(i) / number(POINTS);
                let z = &x * &x;
                let sum = coefficients
                    .iter()
                    .rev()
                    .fold(number(0), |sum, c| sum * &z + exact_number(*c));
                let deviation =
                    (sum - self.target(&x)) * power(&x, self.power) / (self.function)(&x);
                deviation.to_f64().value().abs()
            })
            .fold(0.0, f64::max)
    }

    /// The exact value that the polynomial approximates at an argument.
    fn target(&self, x: &Number) -> Number {
        ((self.function)(x) - (self.lead)(x)) / power(x, self.power)
    }
}

fn power(x: &Number, n: i32) -> Number {
    (1..n).fold(x.clone(), |power, _| power * x)
}
