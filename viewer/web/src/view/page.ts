// The elements of index.html.

export function element<T extends Element = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`index.html has no element #${id}`);
  return found as unknown as T;
}

/** Says what went wrong; an empty message takes the line away. */
export function showError(message: string): void {
  const line = element('error');
  if (line.textContent !== message) line.textContent = message;
  line.hidden = message === '';
}
