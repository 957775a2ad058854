//! What both programs have: completions for shells and manual pages, made from their flags.

use clap::{Args, Command, CommandFactory};
use clap_complete::Shell;
use std::io::{Error, Result, Write};
use std::path::{Path, PathBuf};

/// Arguments of the subcommand `completions`.
#[derive(Debug, Clone, Copy, Args)]
#[command(after_help = "Examples:
  airlight completions bash > ~/.local/share/bash-completion/completions/airlight
  airlight completions zsh > ~/.zfunc/_airlight         (with ~/.zfunc in fpath)
  airlight completions fish > ~/.config/fish/completions/airlight.fish
Of airlight-tools alike.")]
pub struct CompletionArgs {
    /// Shell that completes
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// Arguments of the subcommand `man`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:
  airlight man | man -l -                               (the page of the program)
  airlight man ~/.local/share/man/man1                  (all pages; then man airlight-render)
Of airlight-tools alike.")]
pub struct ManArgs {
    /// Folder to write a page of the program and of each subcommand to; made if it is not there [default: the page of the program to standard
    /// output]
    #[arg(value_name = "DIR")]
    pub folder: Option<PathBuf>,
}

/// The script that makes a shell complete the words of a program.
#[must_use]
pub fn completions<C: CommandFactory>(shell: Shell) -> Vec<u8> {
    let mut command = C::command();
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, name, &mut script);
    script
}

/// The manual pages of a program, in section 1: its own first, then those of its subcommands and theirs, by name: `airlight-scene-new.1`.
///
/// # Errors
/// None that is known: pages are written to memory.
pub fn pages<C: CommandFactory>() -> Result<Vec<(String, Vec<u8>)>> {
    let mut command = C::command().disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    add(&command, command.get_name(), &mut pages)?;
    Ok(pages)
}

fn add(command: &Command, name: &str, pages: &mut Vec<(String, Vec<u8>)>) -> Result<()> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone()).render(&mut page)?;
    pages.push((format!("{name}.1"), page));
    let mut shown = command.get_subcommands().filter(|below| !below.is_hide_set() && below.get_name() != "help");
    shown.try_for_each(|below| add(below, &format!("{name}-{}", below.get_name()), pages))
}

/// Writes the pages to a folder, which is made if it is not there, each with `write`; or the first to standard output. The paths that were written.
///
/// # Errors
/// The path, and why it cannot be written.
pub fn put_pages<C: CommandFactory>(
    folder: Option<&Path>,
    write: impl Fn(&Path, &[u8]) -> Result<()>,
) -> std::result::Result<Vec<PathBuf>, (PathBuf, Error)> {
    let stdout = || PathBuf::from("standard output");
    let pages = pages::<C>().map_err(|error| (stdout(), error))?;
    let Some(folder) = folder else {
        let page = pages.first().map_or(&[][..], |(_, page)| page);
        return match std::io::stdout().lock().write_all(page) {
            // A reader that has seen enough, such as `head`.
            Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err((stdout(), error)),
            _ => Ok(Vec::new()),
        };
    };
    std::fs::create_dir_all(folder).map_err(|error| (folder.to_path_buf(), error))?;
    let put = |(name, page): &(String, Vec<u8>)| {
        let path = folder.join(name);
        write(&path, page).map_err(|error| (path.clone(), error))?;
        Ok(path)
    };
    pages.iter().map(put).collect()
}

/// Flags of a program that take a value and do not say what holds without it, and its commands without examples: both as sentences.
/// For tests of programs.
#[must_use]
pub fn silent<C: CommandFactory>() -> Vec<String> {
    let command = C::command();
    let told =
        |text: Option<&clap::builder::StyledStr>, word: &str| text.is_some_and(|text| text.to_string().contains(word));
    let without = command.get_subcommands().filter(|one| !told(one.get_after_help(), "Example"));
    let mut silent: Vec<String> = without.map(|one| format!("{} has no example", one.get_name())).collect();
    for one in ends(&command) {
        let flags = one.get_arguments().filter(|flag| !flag.is_positional() && !flag.is_required_set());
        let flags = flags.filter(|flag| flag.get_action().takes_values() && flag.get_default_values().is_empty());
        let flags = flags.filter(|flag| !told(flag.get_help(), "default"));
        silent.extend(flags.map(|flag| format!("{} --{} does not say its default", one.get_name(), flag.get_id())));
    }
    silent
}

/// Commands below one that do something, or itself.
fn ends(command: &Command) -> Vec<&Command> {
    let below: Vec<&Command> = command.get_subcommands().flat_map(ends).collect();
    if below.is_empty() { vec![command] } else { below }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    /// Renders pictures.
    #[derive(Parser)]
    #[command(name = "painter", version)]
    enum Painter {
        /// Paints one picture.
        Paint {
            /// Width in pixels, 1 to 9.
            #[arg(long)]
            width: Option<u8>,
        },
        /// Writes scenes.
        #[command(subcommand)]
        Scene(Scene),
    }

    #[derive(clap::Subcommand)]
    enum Scene {
        /// A new one.
        New,
    }

    #[test]
    fn every_subcommand_has_a_page_with_its_flags() {
        let pages = pages::<Painter>().expect("written");
        let names: Vec<&str> = pages.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["painter.1", "painter-paint.1", "painter-scene.1", "painter-scene-new.1"]);
        let page = String::from_utf8_lossy(&pages[1].1).into_owned();
        assert!(page.contains("Width in pixels, 1 to 9") && page.contains("painter\\-paint"), "{page}");
    }

    #[test]
    fn what_is_not_said_is_found() {
        let found = silent::<Painter>();
        let wanted = ["paint has no example", "scene has no example", "paint --width does not say its default"];
        assert_eq!(found, wanted);
    }

    #[test]
    fn every_shell_completes_every_subcommand() {
        for shell in [Shell::Bash, Shell::Elvish, Shell::Fish, Shell::PowerShell, Shell::Zsh] {
            let script = String::from_utf8(completions::<Painter>(shell)).expect("UTF-8");
            assert!(script.contains("paint") && script.contains("scene") && script.contains("width"), "{shell}");
        }
    }
}
