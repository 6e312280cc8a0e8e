/* The link: what is chosen and typed on the page where that is not the default, as the part of the address behind #. */

const inputs = () => [...document.forms].flatMap(form => [...form.elements]).filter(({ name }) => name);

const standard = ({ options }) => ([...options].find(option => option.defaultSelected) ?? options[0])?.value ?? "";

const isDefault = input => {
  if (input.type === "checkbox") return input.checked === input.defaultChecked;
  return input.value === (input.options ? standard(input) : input.defaultValue);
};

/* The link to what is on the page. */
export const linked = () =>
  new URLSearchParams(inputs().flatMap(input => (isDefault(input) ? [] : [[input.name, input.value]]))).toString();

/* Puts what a link has into the inputs of these names, or of all; what it has not is as at first. */
export function take(link, names) {
  const given = new URLSearchParams(link);
  for (const input of inputs().filter(({ name }) => !names || names.includes(name))) {
    const value = given.get(input.name);
    if (input.type === "checkbox") {
      input.checked = value === null ? input.defaultChecked : !input.defaultChecked;
      input.value = value ?? "on";
    } else {
      input.value = value ?? (input.options ? standard(input) : input.defaultValue);
    }
  }
}
