//! The paper's dimensional synthesis (performance-chart-based design methodology), and a search for better designs.

mod chart;
mod performance;
mod proportions;
mod search;

pub use chart::{ChartPoint, compute_chart_points};
pub use performance::{CLAIMED_LCI, LciStatistics, Performance, lci};
pub use proportions::{PROPORTION_SUM, Proportions, grid_points};
pub use search::{BestValues, Design, Requirements, Search, find_design, merge_and_rank};
