//! The solution of a system of three linear equations.

/// Solves `a x = b` for a symmetric, positive semidefinite 3x3 matrix by Gaussian elimination with partial pivoting. If
/// the matrix is singular, a tiny addition to the diagonal selects one of the solutions.
pub(crate) fn solve_symmetric(mut a: [[f64; 3]; 3], mut b: [f64; 3]) -> [f64; 3] {
    let max_diagonal = (0..3).fold(0.0f64, |max, i| max.max(a[i][i]));
    for (i, row) in a.iter_mut().enumerate() {
        row[i] += max_diagonal * 1e-15;
    }
    for column in 0..3 {
        let pivot = (column..3)
            .max_by(|&i, &j| a[i][column].abs().total_cmp(&a[j][column].abs()))
            .unwrap_or(column);
        a.swap(column, pivot);
        b.swap(column, pivot);
        for row in column + 1..3 {
            let factor = a[row][column] / a[column][column];
            let pivot_row = a[column];
            for (entry, pivot_entry) in a[row].iter_mut().zip(pivot_row) {
                *entry -= factor * pivot_entry;
            }
            b[row] -= factor * b[column];
        }
    }
    let mut x = [0.0; 3];
    for row in (0..3).rev() {
        let known_terms: f64 = (row + 1..3).map(|column| a[row][column] * x[column]).sum();
        x[row] = (b[row] - known_terms) / a[row][row];
    }
    x
}
