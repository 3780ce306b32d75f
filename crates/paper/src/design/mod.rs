//! The paper's dimensional synthesis (performance-chart-based design methodology), and a search beyond it.

mod chart;
mod performance;
mod proportions;
mod search;

pub use chart::{Point, chart};
pub use performance::{CLAIM, Conditioning, Performance, lci};
pub use proportions::{Proportions, SUM, triangle};
pub use search::{Demands, Design, Search, design, merge_ranked};
