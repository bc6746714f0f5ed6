// Light and dark: as the system says, until the visitor chooses.
const KEY = 'kiln-theme', root = document.documentElement;

function stored() {
    try {
        return localStorage.getItem(KEY);
    } catch {
        return null; // a browser that keeps nothing
    }
}

const system = matchMedia('(prefers-color-scheme: light)');
const theme = () => root.dataset.theme || (system.matches ? 'light' : 'dark');

// Makes `button` the switch. changed() is called after the theme has changed.
export function makeTheme(button, changed) {
    const show = () => {
        const other = theme() === 'dark' ? 'light' : 'dark';
        button.textContent = theme() === 'dark' ? '☀' : '☾';
        button.title = `Change to the ${other} theme`;
        button.setAttribute('aria-label', button.title);
        changed();
    };
    const chosen = stored();
    if (chosen === 'light' || chosen === 'dark')
        root.dataset.theme = chosen;
    button.onclick = () => {
        root.dataset.theme = theme() === 'dark' ? 'light' : 'dark';
        try {
            localStorage.setItem(KEY, root.dataset.theme);
        } catch {
            // The choice lasts as long as the page.
        }
        show();
    };
    system.addEventListener('change', show);
    show();
}
