//! Films whose truth is known, rendered with all that spoils a picture.

mod accuracy;
mod cameras;
mod render;
mod studio;
mod troubles;
mod walk;
