//! Tests of the program from outside: command lines, messages, files and exit statuses.

mod common;

mod absorbing;
mod check_json;
mod contact;
mod devices;
mod dispersion;
mod examples;
mod faults;
mod fit;
mod folder;
mod formats;
mod geodesics;
mod import;
mod instructions;
mod memory;
mod mesh;
mod messages;
mod plot;
mod processes;
mod quantities;
mod ranks;
mod reproduce;
mod results;
mod resume;
mod resume_details;
mod trust;
mod view;
mod watch;
mod wrong_decks;
