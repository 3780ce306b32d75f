//! Tests with rendered videos whose true values are known, and whose frames have noise, blur and other faults.

mod accuracy;
mod cameras;
mod errors;
mod servos;
mod several_gaits;
mod slides;
mod studio;
