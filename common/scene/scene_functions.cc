#include <common/input_error.h>
#include <common/parameters/parameters.h>
#include <common/printable.h>
#include <common/scene/scene_functions.h>

#include <deal.II/base/point.h>

#include <deal.II/lac/vector.h>

#include <cmath>
#include <sstream>

namespace Friction
{
  namespace
  {
    template <int dim>
    class CheckedFunction : public Function<dim>
    {
    public:
      CheckedFunction(const std::shared_ptr<const Function<dim>> &function,
                      const std::string                          &where,
                      const std::string                          &text,
                      const double                                smallest)
        : Function<dim>(function->n_components)
        , function(function)
        , where(where)
        , text(text)
        , smallest(smallest)
      {}

      void
      vector_value(const Point<dim> &p, Vector<double> &values) const override
      {
        function->vector_value(p, values);
        for (unsigned int c = 0; c < values.size(); ++c)
          check(values[c], p, smallest);
      }

      double
      value(const Point<dim>  &p,
            const unsigned int component = 0) const override
      {
        const double value = function->value(p, component);
        check(value, p, smallest);
        return value;
      }

      Tensor<1, dim>
      gradient(const Point<dim>  &p,
               const unsigned int component = 0) const override
      {
        const Tensor<1, dim> gradient = function->gradient(p, component);
        for (unsigned int d = 0; d < dim; ++d)
          check(gradient[d], p, -largest_number);
        return gradient;
      }

    private:
      void
      check(const double      value,
            const Point<dim> &p,
            const double      smallest_here) const
      {
        if (value >= smallest_here && value <= largest_number)
          return;
        std::ostringstream sentence;
        sentence << where << ": '" << excerpt(text) << "' is ";
        // Not "-nan".
        if (std::isnan(value))
          sentence << "not a number";
        else
          sentence << value;
        sentence << " at (";
        for (unsigned int d = 0; d < dim; ++d)
          sentence << (d > 0 ? ", " : "") << p[d];
        sentence << ")";
        // Zero also where there is no time.
        if (function->get_time() != 0.)
          sentence << " at the time " << function->get_time();
        sentence << ", where a number "
                 << (smallest_here == 0. ? "from 0 up to" : "up to")
                 << " 1e30 is needed; correct it.";
        throw InputError(sentence.str());
      }

      const std::shared_ptr<const Function<dim>> function;
      const std::string                          where;
      const std::string                          text;
      const double                               smallest;
    };



    template <int dim>
    class TurnedFunction : public Function<dim>
    {
    public:
      TurnedFunction(const std::shared_ptr<const Function<dim>> &function,
                     const Tensor<2, dim>                       &rotation)
        : Function<dim>(function->n_components)
        , function(function)
        , rotation(rotation)
      {}

      void
      vector_value(const Point<dim> &p, Vector<double> &values) const override
      {
        const Point<dim> original(transpose(rotation) * p);
        if (this->n_components == 1)
          {
            values[0] = function->value(original);
            return;
          }
        Tensor<1, dim> value;
        for (unsigned int c = 0; c < dim; ++c)
          value[c] = function->value(original, c);
        value = rotation * value;
        for (unsigned int c = 0; c < dim; ++c)
          values[c] = value[c];
      }

      double
      value(const Point<dim>  &p,
            const unsigned int component = 0) const override
      {
        Vector<double> values(this->n_components);
        vector_value(p, values);
        return values[component];
      }

      Tensor<1, dim>
      gradient(const Point<dim>  &p,
               const unsigned int component = 0) const override
      {
        const Point<dim> original(transpose(rotation) * p);
        if (this->n_components == 1)
          return rotation * function->gradient(original);
        Tensor<2, dim> gradient;
        for (unsigned int c = 0; c < dim; ++c)
          gradient[c] = function->gradient(original, c);
        return (rotation * gradient * transpose(rotation))[component];
      }

    private:
      std::shared_ptr<const Function<dim>> function;
      Tensor<2, dim>                       rotation;
    };



    template <int dim>
    class MovedFunction : public Function<dim>
    {
    public:
      MovedFunction(const std::shared_ptr<const Function<dim>>  &function,
                    const std::shared_ptr<const Tensor<1, dim>> &summand)
        : Function<dim>(dim)
        , function(function)
        , summand(summand)
      {}

      double
      value(const Point<dim> &p, const unsigned int component) const override
      {
        return function->value(p, component) + (*summand)[component];
      }

    private:
      std::shared_ptr<const Function<dim>>  function;
      std::shared_ptr<const Tensor<1, dim>> summand;
    };
  } // namespace



  template <int dim>
  std::shared_ptr<const Function<dim>>
  checked_function(const std::shared_ptr<const Function<dim>> &function,
                   const std::string                          &where,
                   const std::string                          &text,
                   const double                                smallest)
  {
    return std::make_shared<CheckedFunction<dim>>(
      function, where, text, smallest);
  }



  template <int dim>
  std::shared_ptr<const Function<dim>>
  moved_function(const std::shared_ptr<const Function<dim>>  &function,
                 const std::shared_ptr<const Tensor<1, dim>> &summand)
  {
    return std::make_shared<MovedFunction<dim>>(function, summand);
  }



  template <int dim>
  std::shared_ptr<const Function<dim>>
  turned_function(const std::shared_ptr<const Function<dim>> &function,
                  const Tensor<2, dim>                       &rotation)
  {
    return std::make_shared<TurnedFunction<dim>>(function, rotation);
  }



  template std::shared_ptr<const Function<1>>
  checked_function(const std::shared_ptr<const Function<1>> &,
                   const std::string &,
                   const std::string &,
                   const double);
  template std::shared_ptr<const Function<2>>
  checked_function(const std::shared_ptr<const Function<2>> &,
                   const std::string &,
                   const std::string &,
                   const double);
  template std::shared_ptr<const Function<3>>
  checked_function(const std::shared_ptr<const Function<3>> &,
                   const std::string &,
                   const std::string &,
                   const double);
  template std::shared_ptr<const Function<2>>
  moved_function(const std::shared_ptr<const Function<2>> &,
                 const std::shared_ptr<const Tensor<1, 2>> &);
  template std::shared_ptr<const Function<3>>
  moved_function(const std::shared_ptr<const Function<3>> &,
                 const std::shared_ptr<const Tensor<1, 3>> &);
  template std::shared_ptr<const Function<2>>
  turned_function(const std::shared_ptr<const Function<2>> &,
                  const Tensor<2, 2> &);
  template std::shared_ptr<const Function<3>>
  turned_function(const std::shared_ptr<const Function<3>> &,
                  const Tensor<2, 3> &);
} // namespace Friction
