//! The generator of the polynomials' coefficients in `src/angle.rs`. A test compares the
//! coefficients there with the generated ones, and prints both if they differ.
//!
//! Each polynomial interpolates a smooth function of the squared argument at Chebyshev nodes, which keeps its largest
//! error within a few percent of the smallest possible for its degree. Nodes, function values and coefficients are
//! computed with a precision of 256 bits; each coefficient is rounded once, to the nearest f64.

use dashu_float::{FBig, round::mode::HalfEven};

/// A number with a precision of [`PRECISION_BITS`].
type Number = FBig<HalfEven, 2>;

/// Precision of every computation, bits.
const PRECISION_BITS: usize = 256;
/// Fraction by which the nodes' interval extends beyond the square of the largest argument, because
/// rounding may push an argument beyond its limit.
const INTERVAL_MARGIN: f64 = 1e-4;
/// Number of points at which an error is measured.
const SAMPLE_COUNT: u32 = 2000;

/// The polynomial P in an approximation f(x) = leading_terms(x) + x^exponent P(x^2).
pub struct Polynomial {
    /// The polynomial's name in `src/angle.rs`.
    pub name: &'static str,
    /// Number of coefficients.
    coefficient_count: u32,
    /// The largest argument x: radians, or a tangent for `ATAN`.
    max_argument: fn() -> Number,
    /// The function f.
    function: fn(&Number) -> Number,
    /// The first terms of the power series of f.
    leading_terms: fn(&Number) -> Number,
    /// The exponent in the factor x^exponent of P.
    exponent: i32,
}

/// All three polynomials, in the order of `src/angle.rs`.
pub const POLYNOMIALS: [Polynomial; 3] = [
    Polynomial {
        name: "SIN",
        coefficient_count: 6,
        max_argument: || Number::pi(PRECISION_BITS) / number_from(4),
        function: Number::sin,
        leading_terms: Number::clone,
        exponent: 3,
    },
    Polynomial {
        name: "COS",
        coefficient_count: 6,
        max_argument: || Number::pi(PRECISION_BITS) / number_from(4),
        function: Number::cos,
        leading_terms: |r| number_from(1) - r * r / number_from(2),
        exponent: 4,
    },
    Polynomial {
        name: "ATAN",
        coefficient_count: 11,
        max_argument: || (Number::pi(PRECISION_BITS) / number_from(8)).tan(),
        function: Number::atan,
        leading_terms: Number::clone,
        exponent: 3,
    },
];

/// Converts an integer exactly.
fn number_from(value: u32) -> Number {
    Number::from(value).with_precision(PRECISION_BITS).value()
}

/// Converts a finite f64 exactly.
fn number_from_f64(value: f64) -> Number {
    let exact = Number::try_from(value).expect("the number is finite");
    exact.with_precision(PRECISION_BITS).value()
}

impl Polynomial {
    /// Computes the coefficients of P, the constant first.
    pub fn compute_coefficients(&self) -> Vec<f64> {
        let max_argument = (self.max_argument)();
        let interval_end =
            &max_argument * &max_argument * (number_from(1) + number_from_f64(INTERVAL_MARGIN));
        let half_interval = interval_end / number_from(2);
        let nodes: Vec<Number> = (0..self.coefficient_count)
            .map(|k| {
                let angle = Number::pi(PRECISION_BITS) * number_from(2 * k + 1)
                    / number_from(2 * self.coefficient_count);
                &half_interval * (number_from(1) + angle.cos())
            })
            .collect();
        // Computes divided differences, then expands Newton's form of P to powers of z = x^2.
        let mut differences: Vec<Number> =
            nodes.iter().map(|z| self.target_value(&z.sqrt())).collect();
        for order in 1..nodes.len() {
            for i in (order..nodes.len()).rev() {
                let rise = &differences[i] - &differences[i - 1];
                differences[i] = rise / (&nodes[i] - &nodes[i - order]);
            }
        }
        let mut coefficients: Vec<Number> = Vec::new();
        for (node, difference) in nodes.iter().zip(&differences).rev() {
            // P becomes P * (z - node) + difference.
            let mut next_coefficients = vec![number_from(0); coefficients.len() + 1];
            for (i, coefficient) in coefficients.iter().enumerate() {
                next_coefficients[i + 1] += coefficient;
                next_coefficients[i] -= coefficient * node;
            }
            next_coefficients[0] += difference;
            coefficients = next_coefficients;
        }
        let to_f64 = |coefficient: &Number| coefficient.to_f64().value();
        coefficients.iter().map(to_f64).collect()
    }

    /// Computes the largest relative error of the approximation with these coefficients.
    pub fn compute_max_relative_error(&self, coefficients: &[f64]) -> f64 {
        let max_argument = (self.max_argument)();
        (1..=SAMPLE_COUNT)
            .map(|i| {
                let x = &max_argument * number_from(i) / number_from(SAMPLE_COUNT);
                let z = &x * &x;
                let sum = coefficients
                    .iter()
                    .rev()
                    .fold(number_from(0), |sum, c| sum * &z + number_from_f64(*c));
                let relative_error =
                    (sum - self.target_value(&x)) * power(&x, self.exponent) / (self.function)(&x);
                relative_error.to_f64().value().abs()
            })
            .fold(0.0, f64::max)
    }

    /// The exact value, at an argument x, that the polynomial P approximates.
    fn target_value(&self, x: &Number) -> Number {
        ((self.function)(x) - (self.leading_terms)(x)) / power(x, self.exponent)
    }
}

/// Returns x^n for n >= 1.
fn power(x: &Number, n: i32) -> Number {
    (1..n).fold(x.clone(), |power, _| power * x)
}
