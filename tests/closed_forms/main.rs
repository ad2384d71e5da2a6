//! Closed forms: results whose value is known without a program.
